/* Embree's occlusion rays in packets of eight, as a C program sends them.

   `embree_rays.py` builds this against the library that embreex brings. That has no headers: what is
   declared here is of Embree 4's rtcore_ray.h, rtcore_common.h and rtcore_scene.h. */

typedef void *Scene;

struct Arguments {
    int flags;
    unsigned features;
    void *context, *filter, *callback;
};

enum { WIDTH = 8, COHERENT = 1 << 16, EVERY = -1 }; /* of RTCRayQueryFlags; masks and features */

struct __attribute__((aligned(32))) Ray8 {
    float x[WIDTH], y[WIDTH], z[WIDTH], near[WIDTH], dx[WIDTH], dy[WIDTH], dz[WIDTH], time[WIDTH];
    float far[WIDTH];
    unsigned mask[WIDTH], id[WIDTH], flags[WIDTH];
};

void rtcOccluded8(const int *valid, Scene, struct Ray8 *, struct Arguments *);

/* Mark which of n rays o + t d, 0 < t < end, meet anything in a committed scene.

   With `stride` 3 there are n directions, with 0 one for all. `coherent` rays are taken for alike. */
void occluded_8(Scene scene, long n, const float *origins, const float *directions, long stride,
                float end, int coherent, unsigned char *occluded) {
    struct Arguments arguments = {coherent ? COHERENT : 0, EVERY, 0, 0, 0};
    struct Ray8 rays;
    int valid[WIDTH] __attribute__((aligned(32)));
    for (long first = 0; first < n; first += WIDTH) {
        for (int k = 0; k < WIDTH; k++) {
            long i = first + k < n ? first + k : n - 1;
            const float *o = origins + 3 * i, *d = directions + stride * i;
            valid[k] = first + k < n ? -1 : 0;
            rays.x[k] = o[0], rays.y[k] = o[1], rays.z[k] = o[2];
            rays.dx[k] = d[0], rays.dy[k] = d[1], rays.dz[k] = d[2];
            rays.near[k] = rays.time[k] = 0;
            rays.far[k] = end;
            rays.mask[k] = EVERY;
            rays.id[k] = rays.flags[k] = 0;
        }
        rtcOccluded8(valid, scene, &rays, &arguments);
        for (int k = 0; k < WIDTH && first + k < n; k++) occluded[first + k] = rays.far[k] < 0;
    }
}

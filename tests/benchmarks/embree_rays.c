/* Embree's occlusion rays as a C program sends them, one by one and in packets of 8 and 16.

   `embree_rays.py` builds this against the library that embreex brings. That has no headers: what is
   declared here is of Embree 4's rtcore_ray.h, rtcore_common.h and rtcore_scene.h.

   All functions mark which rays o + t d, 0 < t <= end, meet anything in a committed scene:
     origins     n times x, y, z
     directions  n times x, y, z; or with `stride` 0 one x, y, z for all rays
     coherent    whether Embree is to take a packet's rays for alike
     occluded    n bytes, 0 or 1 */

typedef void *Scene;

struct Arguments {
    int flags;
    unsigned features;
    void *context, *filter, *callback;
};

struct __attribute__((aligned(16))) Ray {
    float x, y, z, near, dx, dy, dz, time, far;
    unsigned mask, id, flags;
};

void rtcOccluded1(Scene, struct Ray *, struct Arguments *);

enum { COHERENT = 1 << 16, EVERY = -1 }; /* of RTCRayQueryFlags, and of masks and features */

void occluded_1(Scene scene, long n, const float *origins, const float *directions, long stride,
                float end, unsigned char *occluded) {
    struct Arguments arguments = {0, EVERY, 0, 0, 0};
    for (long i = 0; i < n; i++) {
        const float *o = origins + 3 * i, *d = directions + stride * i;
        struct Ray ray = {o[0], o[1], o[2], 0, d[0], d[1], d[2], 0, end, EVERY, 0, 0};
        rtcOccluded1(scene, &ray, &arguments);
        occluded[i] = ray.far < 0; /* minus infinity where anything is met */
    }
}

#define PACKETS_OF(N)                                                                              \
    struct __attribute__((aligned(4 * N))) Ray##N {                                                \
        float x[N], y[N], z[N], near[N], dx[N], dy[N], dz[N], time[N], far[N];                     \
        unsigned mask[N], id[N], flags[N];                                                         \
    };                                                                                             \
                                                                                                   \
    void rtcOccluded##N(const int *valid, Scene, struct Ray##N *, struct Arguments *);             \
                                                                                                   \
    void occluded_##N(Scene scene, long n, const float *origins, const float *directions,          \
                      long stride, float end, int coherent, unsigned char *occluded) {             \
        struct Arguments arguments = {coherent ? COHERENT : 0, EVERY, 0, 0, 0};                    \
        struct Ray##N rays;                                                                        \
        int valid[N] __attribute__((aligned(4 * N)));                                              \
        for (long first = 0; first < n; first += N) {                                              \
            for (int k = 0; k < N; k++) {                                                          \
                long i = first + k < n ? first + k : n - 1;                                        \
                const float *o = origins + 3 * i, *d = directions + stride * i;                    \
                valid[k] = first + k < n ? -1 : 0;                                                 \
                rays.x[k] = o[0], rays.y[k] = o[1], rays.z[k] = o[2];                              \
                rays.dx[k] = d[0], rays.dy[k] = d[1], rays.dz[k] = d[2];                           \
                rays.near[k] = rays.time[k] = 0;                                                   \
                rays.far[k] = end;                                                                 \
                rays.mask[k] = EVERY;                                                              \
                rays.id[k] = rays.flags[k] = 0;                                                    \
            }                                                                                      \
            rtcOccluded##N(valid, scene, &rays, &arguments);                                       \
            for (int k = 0; k < N && first + k < n; k++)                                           \
                occluded[first + k] = rays.far[k] < 0;                                             \
        }                                                                                          \
    }

PACKETS_OF(8)
PACKETS_OF(16)

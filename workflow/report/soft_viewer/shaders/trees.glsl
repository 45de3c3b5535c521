// Rays through the scene's two trees of boxes (viewer/bvh.js): what stays, and what moves, in its
// place at rest.
uniform sampler2D stayingNodes;
uniform sampler2D stayingTriangles;
uniform int stayingCount;
uniform sampler2D movingNodes;
uniform sampler2D movingTriangles;
uniform int movingCount;
uniform mat4 backwards; // the motion's inverse

const float NEARLY_ALL = 0.9999; // a light may lie on a surface

vec4 at(sampler2D data, int i) {
  int width = textureSize(data, 0).x;
  return texelFetch(data, ivec2(i % width, i / width), 0);
}

// Where along a ray a triangle is met: less than `end` and above 0, else `end`.
float meets(sampler2D triangles, int triangle, vec3 p, vec3 way, float end) {
  vec3 a = at(triangles, 3 * triangle).xyz;
  vec3 ab = at(triangles, 3 * triangle + 1).xyz - a, ac = at(triangles, 3 * triangle + 2).xyz - a;
  vec3 side = cross(way, ac);
  float volume = dot(ab, side);
  if (volume == 0.0) return end;
  vec3 from = p - a, other = cross(from, ab);
  float u = dot(from, side) / volume, v = dot(way, other) / volume, t = dot(ac, other) / volume;
  return u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0 ? min(t, end) : end;
}

float walk(sampler2D nodes, sampler2D triangles, int count, vec3 p, vec3 way, float end, bool any_) {
  vec3 inverse = 1.0 / mix(vec3(1e-20), way, greaterThan(abs(way), vec3(1e-20)));
  int node = 0;
  while (node < count) {
    vec4 low = at(nodes, 2 * node), high = at(nodes, 2 * node + 1);
    vec3 one = (low.xyz - p) * inverse, two = (high.xyz - p) * inverse;
    vec3 near = min(one, two), far = max(one, two);
    bool crossed = max(max(near.x, near.y), max(near.z, 0.0)) <= min(min(far.x, end), min(far.y, far.z));
    int leaf = int(high.w); // first triangle · 8 + how many; 0 for an inner node
    if (crossed)
      for (int k = 0; k < leaf % 8; k++) {
        end = meets(triangles, leaf / 8 + k, p, way, end);
        if (any_ && end < NEARLY_ALL) return end;
      }
    node = crossed && leaf == 0 ? node + 1 : int(low.w);
  }
  return end;
}

// The free share of the way from p along `way`, NEARLY_ALL if all of it is; of any blocker, or of the first.
float freeShare(vec3 p, vec3 way, bool any_) {
  float end = walk(stayingNodes, stayingTriangles, stayingCount, p, way, NEARLY_ALL, any_);
  if (any_ && end < NEARLY_ALL) return end;
  vec3 rest = (backwards * vec4(p, 1.0)).xyz;
  return walk(movingNodes, movingTriangles, movingCount, rest, mat3(backwards) * way, end, any_);
}

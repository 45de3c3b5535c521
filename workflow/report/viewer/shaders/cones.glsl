// The share of a light that a cone sees past a field of distances: a translation of field_cones.py,
// whose constants these are. After discs.glsl and field_values.glsl.
uniform sampler3D around; // distances at the bricks' corners, negative inside
uniform float unit;       // radii of a value
uniform float push;       // of the surface outwards, in cells

const int DISCS = 8;
const float FAR = 1e9, DEPTH = 1.3, ALONG = 0.8, PUSHED_FROM = 60.0;
const float STEP_CELLS = 0.5, STEP_SHARE = 0.25;

float cornersBetween(ivec3 corner, vec3 w) {
  #define CORNER(i, j, k) texelFetch(around, corner.zyx + ivec3(k, j, i), 0).x
  return mix(
    mix(mix(CORNER(0, 0, 0), CORNER(0, 0, 1), w.z), mix(CORNER(0, 1, 0), CORNER(0, 1, 1), w.z), w.y),
    mix(mix(CORNER(1, 0, 0), CORNER(1, 0, 1), w.z), mix(CORNER(1, 1, 0), CORNER(1, 1, 1), w.z), w.y),
    w.x);
}

float distanceAt(vec3 p) {
  int size = textureSize(grid, 0).x;
  vec3 border = clamp(p, -1.0, 1.0), at = (border + 1.0) * float(size) / 2.0;
  float beyond = distance(p, border);
  ivec3 brick = clamp(ivec3(at), 0, size - 1);
  int found = texelFetch(grid, brick.zyx, 0).x;
  if (found >= 0) {
    float near = value(firstValue(found), clamp((at - vec3(brick)) * CELLS, 0.0, CELLS));
    if (abs(near) < 120.0) return beyond - near * unit; // 127: or farther
  }
  return beyond + cornersBetween(brick, at - vec3(brick));
}

// The least distance over the cone's radius from `first` to `goal`, at most m, and where that first is
// below 1. Whole: not to be split later; depths inside are corrected then.
float march(vec3 o, vec3 d, float wide, float first, float goal, float m, bool whole, out float touched) {
  touched = FAR;
  float along = dot(o, d), radius = 1.0 + wide * (abs(along) + 1.0);
  float inside = along * along - (dot(o, o) - radius * radius);
  if (inside <= 0.0) return m;
  float root = sqrt(inside), t = max(first, -along - root), end = min(goal, root - along);
  float cell = 2.0 / (CELLS * float(textureSize(grid, 0).x));
  float before = 0.0, step = 0.0;
  while (t < end) {
    float far = distanceAt(o + t * d) - min(push * cell, push / PUSHED_FROM * t);
    float r = wide * t, aside = far;
    if (far < r && touched == FAR) touched = t;
    if (whole && far < 0.0) {
      float rate = step > 0.0 ? min(abs(far - before) / step, 1.0) : 0.0;
      aside *= DEPTH / sqrt(1.0 - ALONG * rate * rate);
    }
    if (aside < m * r) {
      m = aside / r;
      if (m <= -1.0) break;
    }
    before = far;
    step = max((far - m * r) / (1.0 + max(m, 0.0) * wide), STEP_SHARE * r + STEP_CELLS * cell);
    t += step;
  }
  return m;
}

// From a point with a normal to a disc `goal` away, whose radius is `slope` of that.
float coneVisibility(vec3 p, vec3 n, vec3 d, float slope, float goal) {
  float begin = 2.0 / (CELLS * float(textureSize(grid, 0).x)), touched, unused;
  float m = march(p, d, slope, begin, goal, min(dot(n, d) / slope, 1.0), false, touched);
  if (abs(m) >= 1.0) return halfDisc(m);
  // Partly covered: narrower cones, each with an edge of its own, from the first contact on.
  begin = touched < FAR ? max(begin, 0.9 * touched) : FAR;
  float narrow = slope / sqrt(float(DISCS)), sum = 0.0;
  mat2x3 sides = sidesOf(d);
  for (int k = 0; k < DISCS; k++) {
    float angle = 6.283185307179586 * float(k - 1) / float(DISCS - 1), away = k > 0 ? sqrt(0.5) : 0.0;
    vec3 part = normalize(d + slope * away * (sides * vec2(cos(angle), sin(angle))));
    float edge = min(dot(n, part) / narrow, 1.0);
    sum += halfDisc(edge > -1.0 ? march(p, part, narrow, begin, goal, edge, true, unused) : edge);
  }
  return sum / float(DISCS);
}

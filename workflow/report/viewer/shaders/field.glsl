// Whether an occupancy field blocks a ray; see field_occlusion.py for a solid and field_marching.py
// for a sheet, of which this is a translation.
uniform float level;
uniform float depthBias;
uniform bool sheet;

float firstCrossing(vec3 o, vec3 d, float chord) {
  int size = textureSize(grid, 0).x;
  float scale = float(size) / 2.0, step = 1.0 / (scale * CELLS * SAMPLES_PER_CELL);
  vec3 origin = (o + 1.0) * scale, speed = d * scale;
  bvec3 moves = greaterThan(abs(speed), vec3(1e-9));
  vec3 inverse = 1.0 / mix(vec3(1.0), speed, moves);
  vec3 ahead = vec3(greaterThan(d, vec3(0.0)));
  int i = 0, known = -2;
  float before = 0.0, t = 0.5 * step;
  while (t < chord) {
    vec3 at = origin + t * speed;
    ivec3 brick = clamp(ivec3(at), 0, size - 1);
    int found = texelFetch(grid, brick.zyx, 0).x;
    if (found == SOLID) return t;
    float free = float(max(-found, 1));
    vec3 end = vec3(brick) + mix(vec3(1.0 - free), vec3(free), ahead);
    vec3 ways = mix(vec3(4.0), (end - at) * inverse, moves);
    float leave = t + max(min(ways.x, min(ways.y, ways.z)), 0.0);
    if (found < 0) {
      i = max(i + 1, int(ceil(leave / step - 0.5)));
      t = (float(i) + 0.5) * step;
      continue;
    }
    ivec2 first = firstValue(found);
    do {
      at = origin + t * speed;
      float now = value(first, clamp((at - vec3(brick)) * CELLS, 0.0, CELLS));
      bool follows = known == i - 1;
      if (sheet ? follows && (now > level) != (before > level) : now > level)
        return follows ? t - step * (now - level) / (now - before) : t;
      before = now;
      known = i;
      i++;
      t = (float(i) + 0.5) * step;
    } while (t < leave && t < chord);
  }
  return 4.0;
}

bool isInside(vec3 p) {
  int size = textureSize(grid, 0).x;
  vec3 at = (p + 1.0) * float(size) / 2.0;
  ivec3 brick = clamp(ivec3(at), 0, size - 1);
  int found = texelFetch(grid, brick.zyx, 0).x;
  if (found < 0) return found == SOLID;
  ivec2 first = firstValue(found);
  return value(first, clamp((at - vec3(brick)) * CELLS, 0.0, CELLS)) > level;
}

bool lit(vec3 p, vec3 light) {
  vec3 o;
  float s, chord;
  if (!sphereRay(p, light, o, s, chord)) return true;
  if (sheet) return min(s, chord) <= firstCrossing(o, -light, chord) + depthBias;
  // Of a solid no depth is needed: a sample before the point lies inside, or the point itself.
  float end = min(s - depthBias, chord);
  return end <= 0.0 || firstCrossing(o, -light, end) > end && !isInside(o - light * end);
}

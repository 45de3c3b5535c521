// Whether an occupancy field blocks a ray: a translation of field_marching.py.
uniform float level;
uniform float depthBias;
uniform bool sheet;

// Whether a cell of a sheet tells its sides: one that it touches, or with all corners on one side.
bool hasSides(int brick, ivec2 first, vec3 at) {
#ifdef TOUCHED
  ivec3 cell = min(ivec3(at), ivec3(3));
  int bit = 16 * cell.x + 4 * cell.y + cell.z;
  ivec2 word = ivec2(brick % ROW_BRICKS * 2 + bit / 32, brick / ROW_BRICKS);
  if ((texelFetch(touched, word, 0).x >> uint(bit % 32) & 1u) == 1u) return true;
  first.x += (cell.x * 5 + cell.y) * 5 + cell.z;
  int behind = 0;
  for (int c = 0; c < 8; c++) {
    int corner = (c >> 2) * 25 + (c >> 1 & 1) * 5 + (c & 1);
    behind += int(float(texelFetch(values, first + ivec2(corner, 0), 0).x) > level);
  }
  return behind == 0 || behind == 8;
#else
  return true;
#endif
}

float firstCrossing(vec3 o, vec3 d, float chord) {
  int size = textureSize(grid, 0).x;
  float scale = float(size) / 2.0, step = 1.0 / (scale * CELLS * SAMPLES_PER_CELL);
  vec3 origin = (o + 1.0) * scale, speed = d * scale;
  bvec3 moves = greaterThan(abs(speed), vec3(1e-9));
  vec3 inverse = 1.0 / mix(vec3(1.0), speed, moves);
  vec3 ahead = vec3(greaterThan(d, vec3(0.0)));
  int i = 0, known = -2;
  bool sided = false;
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
      vec3 within = clamp((at - vec3(brick)) * CELLS, 0.0, CELLS);
      float now = value(first, within);
      bool follows = known == i - 1, sidedBefore = sided;
      sided = !sheet || hasSides(found, first, within);
      if (sheet ? follows && (now > level) != (before > level) && sided && sidedBefore : now > level)
        return follows ? t - step * (now - level) / (now - before) : t;
      before = now;
      known = i;
      i++;
      t = (float(i) + 0.5) * step;
    } while (t < leave && t < chord);
  }
  return 4.0;
}

// 1 within a solid or behind a sheet, 0 outside, 2 where no side is known.
int sideOf(vec3 p) {
  int size = textureSize(grid, 0).x;
  vec3 at = (p + 1.0) * float(size) / 2.0;
  ivec3 brick = clamp(ivec3(at), 0, size - 1);
  int found = texelFetch(grid, brick.zyx, 0).x;
  if (found < 0) return found == SOLID ? 1 : 2;
  ivec2 first = firstValue(found);
  vec3 within = clamp((at - vec3(brick)) * CELLS, 0.0, CELLS);
  if (sheet && !hasSides(found, first, within)) return 2;
  return int(value(first, within) > level);
}

bool lit(vec3 p, vec3 light) {
  vec3 o;
  float s, chord;
  if (!sphereRay(p, light, o, s, chord)) return true;
#ifndef TOUCHED
  if (sheet) return min(s, chord) <= firstCrossing(o, -light, chord) + depthBias;
#endif
  // No depth is needed: any sample before the point blocks it, or the point itself.
  float end = min(s - depthBias, chord);
  if (end <= 0.0) return true;
  if (firstCrossing(o, -light, end) <= end) return false;
  int side = sideOf(o - light * end);
  if (!sheet) return side != 1;
  float step = 1.0 / (float(textureSize(grid, 0).x) / 2.0 * CELLS * SAMPLES_PER_CELL);
  float last = (ceil(end / step - 0.5) - 0.5) * step; // sample before the point
  return last <= 0.0 || side + sideOf(o - light * last) != 1;
}

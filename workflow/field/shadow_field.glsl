// Shadow rays through a field that neural_shadows' ShadowField has saved: GLSL ES 3.00 (WebGL2), GLSL 3.30.
//
//     bool lit(vec3 p, vec3 light) // p = (place - centre) / radius; light: unit vector to the light
//
// Define before it
//     SOLID             -1048576
//     ROW_BRICKS        bricks a row of `values`, such as 32
//     SAMPLES_PER_CELL  2.0
//     TOUCHED           for a sheet alone
// and set
//     grid       R32I, 3D, B^3, texel (z, y, x): of each code of the file's `grid` the number of the brick, counted
//                in the file's order, for 0; SOLID for 255; else -code
//     values     R8I, 125 ROW_BRICKS wide: the file's `bricks`, row by row
//     touched    R32UI, 2 ROW_BRICKS wide, of a sheet: the file's `cells` as low and high words
//     sheet      whether the file has `cells`
//     level      0.0
//     depthBias  0.0, or how much nearer to the light a point is taken to be, in radii
// sample.html does so. Below are the files of the viewer's own shader, joined: a test compares them.

// The ray from the light to p where it enters the unit sphere; see networks' sphere_rays.py. False
// for a point that is culled, and lit.
bool sphereRay(vec3 p, vec3 light, out vec3 o, out float s, out float chord) {
  float along = dot(p, light);
  vec3 aside = p - along * light;
  float square = 1.0 - dot(aside, aside);
  if (square <= 0.0) return false;
  float halfChord = sqrt(square);
  s = halfChord - along;
  o = aside + halfChord * light;
  chord = 2.0 * halfChord;
  return s > 0.0;
}
// An occupancy field in bricks of four cells along an axis: values of those that the surface touches.
uniform isampler3D grid;   // a brick's number; −how many may be skipped; or SOLID
uniform isampler2D values; // ROW_BRICKS bricks a row, 125 values each
#ifdef TOUCHED
uniform usampler2D touched; // of a sheet, ROW_BRICKS a row: two words each, a bit a cell that it touches
#endif

const float CELLS = 4.0; // of a brick along an axis

// Of a brick by its first value, between its corners 0 and 4.
float value(ivec2 brick, vec3 at) {
  ivec3 cell = min(ivec3(at), ivec3(3));
  vec3 w = at - vec3(cell);
  ivec2 first = brick + ivec2((cell.x * 5 + cell.y) * 5 + cell.z, 0);
  #define AT(i) float(texelFetch(values, first + ivec2(i, 0), 0).x)
  float a = mix(AT(0), AT(1), w.z), b = mix(AT(5), AT(6), w.z);
  float c = mix(AT(25), AT(26), w.z), e = mix(AT(30), AT(31), w.z);
  return mix(mix(a, b, w.y), mix(c, e, w.y), w.x);
}

ivec2 firstValue(int brick) {
  return ivec2(brick % ROW_BRICKS * 125, brick / ROW_BRICKS);
}
// Whether an occupancy field blocks a ray; see field_occlusion.py for a solid and field_marching.py
// for a sheet, of which this is a translation.
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

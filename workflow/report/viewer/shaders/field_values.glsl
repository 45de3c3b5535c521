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

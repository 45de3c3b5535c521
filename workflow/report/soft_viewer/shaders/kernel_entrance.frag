// Base, and guide if any, among a frame's planes, as squares of 2 × 2 pixels.
uniform usampler2DArray planes;
uniform int base;
layout(location = 0) out uvec4 squareOfBase;
#ifdef EDGE
uniform int guide;
layout(location = 1) out uvec4 squareOfGuide;
#endif

float planeAt(int number, ivec2 pixel) { return floatsAt(planes, ivec3(pixel, number >> 2))[number & 3]; }

uvec4 square(int number) {
  ivec2 p = 2 * ivec2(gl_FragCoord.xy), q = p + 1;
  return bitsOf(vec4(planeAt(number, p), planeAt(number, ivec2(q.x, p.y)), planeAt(number, ivec2(p.x, q.y)), planeAt(number, q)));
}

void main() {
  squareOfBase = square(base);
#ifdef EDGE
  squareOfGuide = square(guide);
#endif
}

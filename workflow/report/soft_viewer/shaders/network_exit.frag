// Visibility of a map's first channel, or of four: the first enlarged bilinearly, the others added to the
// upper right, lower left and lower right of 2 × 2 pixels.
uniform Map source;
uniform ivec2 sourceTile;
layout(location = 0) out uvec4 visibility;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
#ifdef SQUARES
  ivec2 near = pixel >> 1, far = clamp(near + 2 * (pixel & 1) - 1, ivec2(0), ivec2(4, 2) * sourceTile - 1);
  vec4 square = pixelAt(source, near, 0);
  float beside = pixelAt(source, ivec2(far.x, near.y), 0).r + pixelAt(source, ivec2(near.x, far.y), 0).r;
  float enlarged = 0.5625 * square.r + 0.1875 * beside + 0.0625 * pixelAt(source, far, 0).r;
  int corner = 2 * (pixel.y & 1) + (pixel.x & 1);
  visibility = bitsOf(vec4(enlarged + (corner == 0 ? 0.0 : square[corner])));
#else
  visibility = bitsOf(vec4(pixelAt(source, pixel, 0).r));
#endif
}

// Squares of 2 × 2 pixels as pixels.
uniform usampler2D source;
layout(location = 0) out uvec4 visibility;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  visibility = bitsOf(vec4(floatsAt(source, pixel >> 1)[2 * (pixel.y & 1) + (pixel.x & 1)]));
}

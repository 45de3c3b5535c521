// Squares of 2 × 2 pixels as pixels.
uniform sampler2D source;
layout(location = 0) out vec4 visibility;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  visibility = vec4(texelFetch(source, pixel >> 1, 0)[2 * (pixel.y & 1) + (pixel.x & 1)]);
}

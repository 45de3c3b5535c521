// Both pictures on the canvas, smoothly enlarged to cover it.
uniform sampler2D left;
uniform sampler2D right;
uniform vec2 canvasSize;
uniform vec2 cover; // shares of the pictures that the canvas shows
uniform float divider; // a share of the canvas's width
layout(location = 0) out vec4 colour;

void main() {
  vec2 at = gl_FragCoord.xy / canvasSize;
  vec2 place = 0.5 + (vec2(at.x, 1.0 - at.y) - 0.5) * cover;
  colour = at.x < divider ? texture(left, place) : texture(right, place);
}

// The grey picture (rendering/shading.py) of two methods' answers, left and right of the divider; or
// where a method is wrong: vermilion where it has a false shadow, blue where light leaks.
uniform sampler2D shadingNormals;
uniform sampler2D left;
uniform sampler2D right;
uniform sampler2D reference;
uniform vec3 light;
uniform float divider; // in pixels of the answers
uniform bool errors;
uniform vec2 share; // pixels of the answers by those of the canvas
layout(location = 0) out vec4 colour;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy * share);
  vec4 answer = float(at.x) + 0.5 < divider ? texelFetch(left, at, 0) : texelFetch(right, at, 0);
  if (answer.y == 0.0) {
    colour = vec4(vec3(BACKGROUND), 1.0);
    return;
  }
  float lambert = max(dot(texelFetch(shadingNormals, at, 0).xyz, light), 0.0);
  float grey = AMBIENT + (1.0 - AMBIENT) * lambert * answer.x;
  colour = vec4(vec3(grey), 1.0);
  if (!errors) return;
  float wrong = answer.x - texelFetch(reference, at, 0).x;
  vec3 hue = wrong < 0.0 ? vec3(0.835, 0.369, 0.0) : vec3(0.0, 0.447, 0.698);
  colour.rgb = mix(vec3(0.55 + 0.4 * grey), hue, min(abs(wrong), 1.0));
}

// The picture of two methods' answers, left and right of the divider, in the light of sun and sky; or
// where a method is wrong: vermilion where it has a false shadow, blue where light leaks. Normals and
// answers may be coarser than the picture, and are interpolated.
uniform sampler2D shadingNormals; // w: 1 where there is a surface
uniform sampler2D left;
uniform sampler2D right;
uniform sampler2D reference;
uniform vec3 sun;
uniform vec3 up;
uniform vec2 canvas;   // its pixels
uniform float divider; // in these
uniform bool errors;
layout(location = 0) out vec4 colour;

// Of a white face turned to the light: of the sun, of the sky above, and of the ground from below.
const vec3 SUN = vec3(0.53, 0.50, 0.46), SKY = vec3(0.45, 0.48, 0.53), BELOW = vec3(0.28, 0.27, 0.26);

// By hand: not every device filters floating-point textures.
vec4 between(sampler2D data) {
  ivec2 last = textureSize(data, 0) - 1;
  vec2 place = gl_FragCoord.xy / canvas * vec2(last + 1) - 0.5, w = fract(place);
  ivec2 at = ivec2(floor(place)), low = clamp(at, ivec2(0), last), high = clamp(at + 1, ivec2(0), last);
  return mix(
    mix(texelFetch(data, low, 0), texelFetch(data, ivec2(high.x, low.y), 0), w.x),
    mix(texelFetch(data, ivec2(low.x, high.y), 0), texelFetch(data, high, 0), w.x), w.y);
}

// The mean of its sums, weighted by how many each has.
float visibilityOf(vec4 answer) {
  return answer.y > 0.0 ? answer.x / answer.y : 1.0;
}

void main() {
  vec4 normal = between(shadingNormals);
  vec3 n = normal.w > 0.0 ? normalize(normal.xyz) : up;
  float visibility = visibilityOf(gl_FragCoord.x < divider ? between(left) : between(right));
  vec3 light = mix(BELOW, SKY, 0.5 + 0.5 * dot(n, up)) + SUN * max(dot(n, sun), 0.0) * visibility;
  if (errors) {
    float wrong = visibility - visibilityOf(between(reference));
    vec3 hue = wrong < 0.0 ? vec3(0.835, 0.369, 0.0) : vec3(0.0, 0.447, 0.698);
    light = mix(vec3(0.5 + 0.45 * light.g), hue, min(abs(wrong), 1.0));
  }
  colour = vec4(mix(vec3(BACKGROUND), light, normal.w), 1.0);
}

// A method's answer at each surface point: x the sum of its visibilities, y how many those are; 0
// where there is no surface. More are added by blending. The files after this define `visibility`.
uniform usampler2D points;
uniform usampler2D faceNormals;
uniform vec3 sun;    // unit vector to the middle of the sun's disc
uniform float slope; // tangent of the disc's angular radius; 0 for a point
layout(location = 0) out vec4 answer;

// Of a point and the normal of its face, on the camera's side.
vec2 visibility(vec3 p, vec3 n);

// Two numbers in [0, 1) of this pixel (Jarzynski and Olano 2020).
vec2 noise() {
  uvec2 v = uvec2(gl_FragCoord.xy) * 1664525u + 1013904223u;
  v.x += v.y * 1664525u;
  v.y += v.x * 1664525u;
  v ^= v >> 16u;
  v.x += v.y * 1664525u;
  v.y += v.x * 1664525u;
  v ^= v >> 16u;
  return vec2(v >> 8u) / 16777216.0;
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec4 point = floatsAt(points, at);
  answer = vec4(0.0);
  if (point.w > 0.0) answer.xy = visibility(point.xyz, floatsAt(faceNormals, at).xyz);
}

// A method's answer at each surface point: x visibility, y kind / 2. The method's own file,
// which comes after this, defines `visibility`.
uniform sampler2D points;
uniform sampler2D faceNormals;
uniform vec3 light;
layout(location = 0) out vec4 answer;

float visibility(vec3 p, float cosGeometric);

// The ray from the light to p where it enters the unit sphere; see networks' sphere_rays.py. False
// for a point that is culled, and lit.
bool sphereRay(vec3 p, out vec3 o, out float s, out float chord) {
  float along = dot(p, light);
  vec3 across = p - along * light;
  float square = 1.0 - dot(across, across);
  if (square <= 0.0) return false;
  float halfChord = sqrt(square);
  s = halfChord - along;
  o = across + halfChord * light;
  chord = 2.0 * halfChord;
  return s > 0.0;
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec4 point = texelFetch(points, at, 0);
  answer = vec4(0.0, point.w / 2.0, 0.0, 1.0);
  if (point.w == 0.0) return;
  float cosGeometric = dot(texelFetch(faceNormals, at, 0).xyz, light);
  if (cosGeometric > 0.0) answer.x = visibility(point.xyz, cosGeometric);
}

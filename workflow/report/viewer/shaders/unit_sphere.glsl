// The ray from the light to p where it enters the unit sphere; see networks' sphere_rays.py. False
// for a point that is culled, and lit.
bool sphereRay(vec3 p, vec3 light, out vec3 o, out float s, out float chord) {
  float along = dot(p, light);
  vec3 aside = p - along * light;
  float square = 1.0 - dot(aside, aside);
  if (square <= 0.0) return false;
  float halfChord = sqrt(square);
  s = halfChord - along;
  o = aside + halfChord * light;
  chord = 2.0 * halfChord;
  return s > 0.0;
}

// Of a cone without width: a ray through a field, by the march of field.glsl from the light's end.
float coneVisibility(vec3 p, vec3 n, vec3 d, float slope, float goal) {
  float along = dot(p, d);
  vec3 aside = p - along * d;
  float inside = 1.0 - dot(aside, aside);
  if (inside <= 0.0) return 1.0;
  float root = sqrt(inside), begin = max(along, -root), end = min(along + goal, root);
  if (begin >= end) return 1.0;
  bool blocked = firstCrossing(aside + end * d, -d, end - begin) < end - begin;
  return float(!blocked && sideOf(aside + begin * d) != 1);
}

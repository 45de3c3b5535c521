vec2 visibility(vec3 p, vec3 n) {
  return vec2(dot(n, sun) > 0.0, 1.0);
}

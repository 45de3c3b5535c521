float visibility(vec3 p, float cosGeometric) {
  return 1.0;
}

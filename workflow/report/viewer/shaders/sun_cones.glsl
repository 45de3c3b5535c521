// Of a sun, which is as far as nothing in the unit sphere.
vec2 visibility(vec3 p, vec3 n) { return vec2(coneVisibility(p, n, sun, slope, FAR), 1.0); }

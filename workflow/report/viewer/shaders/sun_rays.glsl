// Rays over the sun's disc, one in its middle if it has no size. The next file defines `lit`.
uniform int first; // of all rays of a pixel, those of this pass
uniform int rays;

bool lit(vec3 p, vec3 light);

// Any first few spread over the disc, turned anew at each pixel (Roberts 2018).
vec3 towardsDisc(int k, vec2 start) {
  if (slope == 0.0) return sun;
  vec2 place = fract(start + float(k) * vec2(0.7548776662466927, 0.5698402909980532));
  float angle = 6.283185307179586 * place.y;
  return normalize(sun + slope * sqrt(place.x) * (sidesOf(sun) * vec2(cos(angle), sin(angle))));
}

vec2 visibility(vec3 p, vec3 n) {
  vec2 start = noise();
  float sum = 0.0;
  for (int k = first; k < first + rays; k++) {
    vec3 light = towardsDisc(k, start);
    if (dot(n, light) > 0.0 && lit(p, light)) sum++;
  }
  return vec2(sum, rays);
}

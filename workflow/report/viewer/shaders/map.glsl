// See shadow_maps/depth_test.py.
uniform sampler2D heights;
uniform mat3 basis;
uniform vec3 corner;
uniform float side;
uniform bool filtered; // 2 × 2 percentage-closer filtering

float test(float height, ivec2 texel) {
  ivec2 last = textureSize(heights, 0) - 1;
  return height >= texelFetch(heights, clamp(texel, ivec2(0), last), 0).x ? 1.0 : 0.0;
}

float visibility(vec3 p, float cosGeometric) {
  vec3 seen = p * basis;
  vec2 place = (seen.xy - corner.xy) / side;
  if (any(lessThan(place, vec2(0.0))) || any(greaterThanEqual(place, vec2(1.0)))) return 1.0;
  float resolution = float(textureSize(heights, 0).x);
  float cosine = clamp(cosGeometric, 0.01, 1.0);
  float slope = min(0.5 + 0.75 * sqrt(1.0 / (cosine * cosine) - 1.0), 20.0);
  float height = seen.z + slope * side / resolution + 1e-4;
  vec2 texel = place * resolution;
  if (!filtered) return test(height, ivec2(texel));
  vec2 first = floor(texel - 0.5), share = texel - 0.5 - first;
  ivec2 at = ivec2(first);
  return mix(
    mix(test(height, at), test(height, at + ivec2(1, 0)), share.x),
    mix(test(height, at + ivec2(0, 1)), test(height, at + ivec2(1, 1)), share.x), share.y);
}

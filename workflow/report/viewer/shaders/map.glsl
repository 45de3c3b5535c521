// The map's test, of one texel or filtered over 2 × 2 (percentage-closer filtering).
uniform bool filtered;

float test(float height, ivec2 texel) {
  return height >= heightAt(texel) ? 1.0 : 0.0;
}

vec2 visibility(vec3 p, vec3 n) {
  float cosine = dot(n, sun);
  if (cosine <= 0.0) return vec2(0.0, 1.0);
  vec3 seen = p * basis;
  vec2 texel = placeOf(seen.xy);
  if (!onMap(texel)) return vec2(1.0);
  float height = raised(seen.z, cosine);
  if (!filtered) return vec2(test(height, ivec2(texel)), 1.0);
  vec2 first = floor(texel - 0.5), share = texel - 0.5 - first;
  ivec2 at = ivec2(first);
  return vec2(mix(
    mix(test(height, at), test(height, at + ivec2(1, 0)), share.x),
    mix(test(height, at + ivec2(0, 1)), test(height, at + ivec2(1, 1)), share.x), share.y), 1.0);
}

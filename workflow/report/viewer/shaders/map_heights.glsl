// A shadow map of the sun's middle, and a point beside it; see shadow_maps/depth_test.py.
uniform usampler2D heights;
uniform mat3 basis;    // columns u, v, light
uniform vec3 corner;   // of the map's square, and the least height
uniform float side;    // of the square
uniform float highest; // of all heights

float heightAt(ivec2 texel) {
  return floatsAt(heights, clamp(texel, ivec2(0), textureSize(heights, 0) - 1)).x;
}

// In texels.
vec2 placeOf(vec2 seen) {
  return (seen - corner.xy) / side * vec2(textureSize(heights, 0));
}

bool onMap(vec2 texel) {
  return all(greaterThanEqual(texel, vec2(0.0))) && all(lessThan(texel, vec2(textureSize(heights, 0))));
}

// A point's height as it is tested; cosine: of its face and the light.
float raised(float height, float cosine) {
  cosine = clamp(cosine, 0.01, 1.0);
  float texels = min(0.5 + 0.75 * sqrt(1.0 / (cosine * cosine) - 1.0), 20.0);
  return height + texels * side / float(textureSize(heights, 0).x) + 1e-4;
}

// A pass of the filter like FidelityFX's (denoising/ffx.py): x visibility, y the variance of its noise.
uniform usampler2D picture;
uniform usampler2D means; // of the first pass; its variance is the neighbourhood's
uniform usampler2D points;
uniform usampler2D normals;
uniform vec3 eye, forward;
uniform int step_;
uniform bool begins;
layout(location = 0) out uvec4 smoothed;

const float SIGMA = 4.0, SIGMA_DEPTH = 0.02, BOOST = 4.0;

vec2 lightAt(ivec2 at) {
  vec2 values = floatsAt(picture, at).xy;
  if (!begins) return values;
  float mean = floatsAt(means, at).x;
  return vec2(values.x, (BOOST - 1.0) * max(mean - mean * mean, 0.0));
}

float depthAt(ivec2 at) {
  vec4 point = floatsAt(points, at);
  return point.w > 0.0 ? dot(point.xyz - eye, forward) : 0.0;
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy), size = textureSize(picture, 0);
  vec2 own = lightAt(at);
  float spread = 0.0;
  for (int y = -1; y <= 1; y++)
    for (int x = -1; x <= 1; x++)
      spread += float((2 - abs(x)) * (2 - abs(y))) / 16.0 * lightAt(clamp(at + ivec2(x, y), ivec2(0), size - 1)).y;
  float sharp = 1.0 / (SIGMA * sqrt(spread + 1e-9)), z = depthAt(at), total = 1.0;
  vec3 n = floatsAt(normals, at).xyz;
  vec2 sum = own;
  for (int y = -1; y <= 1; y++)
    for (int x = -1; x <= 1; x++) {
      ivec2 tap = at + step_ * ivec2(x, y);
      if ((x == 0 && y == 0) || tap != clamp(tap, ivec2(0), size - 1)) continue;
      vec2 light = lightAt(tap);
      float cosine = dot(n, floatsAt(normals, tap).xyz);
      float t = abs(own.x - light.x) * sharp + abs(z - depthAt(tap)) / (SIGMA_DEPTH * z + 1e-12);
      if (cosine < 0.5 || t > 20.0) continue;
      float weight = (x == 0 ? 1.0 : 2.0 / 3.0) * (y == 0 ? 1.0 : 2.0 / 3.0) * exp(-t) * pow(cosine, 32.0);
      total += weight;
      sum += weight * vec2(light.x, weight * light.y);
    }
  smoothed = bitsOf(vec4(sum.x / total, sum.y / (total * total), 0.0, 0.0));
}

// Gaussian means over 17 pixels of a row, then of a column (denoising/mixed_blocks.py).
uniform usampler2D picture;
uniform ivec2 way;
layout(location = 0) out uvec4 mean;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy), last = textureSize(picture, 0) - 1;
  float total = 0.0, sum = 0.0;
  for (int k = -8; k <= 8; k++) {
    float weight = exp(-3.0 * float(k * k) / 81.0);
    total += weight;
    sum += weight * floatsAt(picture, clamp(at + k * way, ivec2(0), last)).x;
  }
  mean = bitsOf(vec4(sum / total));
}

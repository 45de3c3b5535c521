// Bilinear enlargement by two.
uniform Map source;
uniform ivec2 tile, sourceTile;
DECLARE_STORED

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy), last = ivec2(4, 2) * sourceTile - 1;
  int group = texel.x / tile.x;
  texel.x -= group * tile.x;
  vec4 window[12]; // 4 × 3
#unroll k 12
  window[k] = pixelAt(
    source, clamp(ivec2(2, 1) * texel + ivec2(k % 4, k / 4) - 1, ivec2(0), last), group * sourceTile.x);
#end
  vec4 enlarged[8];
#unroll k 8
  {
    const int near = 1 + k % 4 / 2, far = near + 2 * (k % 2) - 1, row = 8 * (k / 4);
    enlarged[k] = 0.5625 * window[4 + near] + 0.1875 * (window[4 + far] + window[row + near])
      + 0.0625 * window[row + far];
  }
#end
#unroll k 4
  STORE(k, withSkip(Pair(enlarged[2 * k], enlarged[2 * k + 1]), k));
#end
}

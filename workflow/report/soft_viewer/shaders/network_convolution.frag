// A convolution of 3 × 3 or 1 × 1 pixels, or a transposed one of 2 × 2 without overlap: four outputs of
// a block, all of whose pixels share what is read of weights and map.
uniform Map source;
uniform usampler2D weights; // a row is 4 outputs × 4 inputs: two texels a tap; in a group's first then the bias
uniform ivec2 tile, sourceTile;
uniform int inputs; // groups of four
DECLARE_STORED

mat4 weightsOf(int tap, int row) {
  uvec4 first = texelFetch(weights, ivec2(2 * tap, row), 0), second = texelFetch(weights, ivec2(2 * tap + 1, row), 0);
  return mat4(unpacked(first.xy), unpacked(first.zw), unpacked(second.xy), unpacked(second.zw));
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  int group = texel.x / tile.x, weightRow = group * inputs;
  texel.x -= group * tile.x;
  vec4 sums[8], bias = unpacked(texelFetch(weights, ivec2(2 * SIZE * SIZE, weightRow), 0).xy);
#unroll k 8
  sums[k] = bias;
#end
#if SIZE == 3
  // Pixels around the block; those beyond a border are the nearest, or with ZERO none.
  ivec2 begin = ivec2(4, 2) * texel - 1, end = ivec2(4, 2) * tile - 1;
  ivec4 rows = clamp(begin.y + ivec4(0, 1, 2, 3), 0, end.y);
  int left = max(begin.x, 0), right = min(begin.x + 5, end.x);
#ifdef ZERO
  vec4 inside = vec4(rows[0] == begin.y, rows[3] == begin.y + 3, left == begin.x, right == begin.x + 5);
#endif
#endif
  for (int i = 0; i < inputs; i++, weightRow++) {
    int column = i * sourceTile.x;
    mat4 m;
#if SIZE == 3
    vec4 window[24]; // 6 × 4
#unroll row 4
    {
      ivec2 place = ivec2(texel.x + column, rows[row] >> 1);
      Pair first = pairAt(source, place, 2 * (rows[row] & 1)), second = pairAt(source, place, 2 * (rows[row] & 1) + 1);
      window[6 * row] = pixelAt(source, ivec2(left, rows[row]), column);
      window[6 * row + 1] = first.left;
      window[6 * row + 2] = first.right;
      window[6 * row + 3] = second.left;
      window[6 * row + 4] = second.right;
      window[6 * row + 5] = pixelAt(source, ivec2(right, rows[row]), column);
#ifdef ZERO
      window[6 * row] *= inside[2];
      window[6 * row + 5] *= inside[3];
#endif
    }
#end
#ifdef ZERO
#unroll k 6
    window[k] *= inside[0];
    window[18 + k] *= inside[1];
#end
#endif
#unroll tap 9
    m = weightsOf(tap, weightRow);
#unroll k 8
    sums[k] += m * window[6 * (k / 4 + tap / 3) + k % 4 + tap % 3];
#end
#end
#elif SIZE == 2
    Pair pair = pairAt(source, (texel >> 1) + ivec2(column, 0), 2 * (texel.y & 1) + (texel.x & 1));
#unroll tap 4
    m = weightsOf(tap, weightRow);
    sums[4 * (tap / 2) + tap % 2] += m * pair.left;
    sums[4 * (tap / 2) + tap % 2 + 2] += m * pair.right;
#end
#else
    m = weightsOf(0, weightRow);
#unroll k 4
    {
      Pair pair = pairAt(source, texel + ivec2(column, 0), k);
      sums[2 * k] += m * pair.left;
      sums[2 * k + 1] += m * pair.right;
    }
#end
#endif
  }
#ifdef RELU
#unroll k 8
  sums[k] = max(sums[k], 0.0);
#end
#endif
#unroll k 4
  STORE(k, withSkip(Pair(sums[2 * k], sums[2 * k + 1]), k));
#end
}

// The largest or the mean of each 2 × 2 pixels.
uniform Map source;
uniform ivec2 tile, sourceTile;
DECLARE_STORED

vec4 pooled(ivec2 texel, int upper) {
  Pair above = pairAt(source, texel, upper), below = pairAt(source, texel, upper + 2);
#ifdef MAXIMUM
  return max(max(above.left, above.right), max(below.left, below.right));
#else
  return (above.left + above.right + below.left + below.right) / 4.0;
#endif
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  int group = texel.x / tile.x;
  ivec2 corner = 2 * (texel - ivec2(group * tile.x, 0)) + ivec2(group * sourceTile.x, 0);
#unroll k 4
  STORE(k, Pair(pooled(corner + ivec2(k % 2, k / 2), 0), pooled(corner + ivec2(k % 2, k / 2), 1)));
#end
}

// A frame's planes as a map, normalised: as they are, 2 × 2 pixels as channels, or their mean.
uniform usampler2DArray planes; // four a layer
uniform sampler2D ranges;      // four a texel: centres, then spreads
uniform ivec2 tile;
DECLARE_STORED

vec4 normalised(ivec2 pixel, int layer) {
  vec4 centre = texelFetch(ranges, ivec2(layer, 0), 0), spread = texelFetch(ranges, ivec2(layer, 1), 0);
  return (floatsAt(planes, ivec3(pixel, layer)) - centre) / spread;
}

mat4 square(ivec2 pixel, int layer) {
  return mat4(
    normalised(2 * pixel, layer), normalised(2 * pixel + ivec2(1, 0), layer),
    normalised(2 * pixel + ivec2(0, 1), layer), normalised(2 * pixel + 1, layer));
}

vec4 channelsAt(ivec2 pixel, int group) {
#if defined(SQUARES)
  return transpose(square(pixel, group >> 2))[group & 3];
#elif defined(MEANS)
  return square(pixel, group) * vec4(0.25);
#else
  return normalised(pixel, group);
#endif
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  int group = texel.x / tile.x;
  ivec2 corner = ivec2(4, 2) * (texel - ivec2(group * tile.x, 0));
#unroll k 4
  {
    ivec2 left = corner + ivec2(2 * (k % 2), k / 2);
    STORE(k, Pair(channelsAt(left, group), channelsAt(left + ivec2(1, 0), group)));
  }
#end
}

// Maps of a network's channels. A texel is a block of 4 × 2 pixels with 4 channels; tiles of further
// channels lie beside it. The four layers of an array texture are pairs of neighbours in half precision,
// two of the upper row and two of the lower; in floats, eight are pixels, and a draw fills those of a row.
struct Pair { vec4 left, right; };

vec4 unpacked(uvec2 halves) { return vec4(unpackHalf2x16(halves.x), unpackHalf2x16(halves.y)); }

#define Map usampler2DArray
#ifdef HALVES
#define DECLARE_STORED layout(location = 0) out uvec4 stored[4];
#define STORE(number, pair) stored[number] = halvesOf(pair)

uvec2 halvesOf(vec4 pixel) { return uvec2(packHalf2x16(pixel.xy), packHalf2x16(pixel.zw)); }
uvec4 halvesOf(Pair pair) { return uvec4(halvesOf(pair.left), halvesOf(pair.right)); }

Pair pairAt(Map map, ivec2 texel, int number) {
  uvec4 halves = texelFetch(map, ivec3(texel, number), 0);
  return Pair(unpacked(halves.xy), unpacked(halves.zw));
}

// Of a tile that begins at a column of texels.
vec4 pixelAt(Map map, ivec2 pixel, int column) {
  ivec3 place = ivec3((pixel.x >> 2) + column, pixel.y >> 1, (pixel.y & 1) * 2 + ((pixel.x >> 1) & 1));
  uvec4 halves = texelFetch(map, place, 0);
  return unpacked((pixel.x & 1) == 0 ? halves.xy : halves.zw);
}
#else
#define DECLARE_STORED uniform int part; layout(location = 0) out uvec4 stored[4];
#define STORE(number, pair) \
  if ((number) / 2 == part) stored[2 * (number) % 4] = bitsOf(pair.left), stored[2 * (number) % 4 + 1] = bitsOf(pair.right)

Pair pairAt(Map map, ivec2 texel, int number) {
  return Pair(floatsAt(map, ivec3(texel, 2 * number)), floatsAt(map, ivec3(texel, 2 * number + 1)));
}

vec4 pixelAt(Map map, ivec2 pixel, int column) {
  return floatsAt(map, ivec3((pixel.x >> 2) + column, pixel.y >> 1, (pixel.y & 1) * 4 + (pixel.x & 3)));
}
#endif

#ifdef SKIP
uniform Map skip;
Pair withSkip(Pair pair, int number) {
  Pair encoded = pairAt(skip, ivec2(gl_FragCoord.xy), number);
  return Pair(pair.left + encoded.left, pair.right + encoded.right);
}
#else
Pair withSkip(Pair pair, int number) { return pair; }
#endif

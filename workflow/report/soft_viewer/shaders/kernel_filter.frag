// One of a network's filters (networks/screen_space/pixel_kernels.py): for each pixel the mean of 5 × 5
// taps, an even number of pixels apart or ADJACENT, by the softmax of its logits over the taps in the
// frame; with EDGE, over those that differ little in the guide. A texel is a square of 2 × 2 pixels, as
// large as one of the logits, which are enlarged bilinearly. The softmax goes on by four taps at a time.
uniform Map logits;
uniform ivec2 tile;
uniform int first; // group of four taps
#ifndef ADJACENT
uniform int dilation;
#endif
uniform usampler2D source;
#ifdef EDGE
uniform usampler2D guides;
uniform float edge;
#endif
layout(location = 0) out uvec4 filtered;

const float LEAST = -1e30; // as a logit: no weight

void main() {
  ivec2 here = ivec2(gl_FragCoord.xy), last = textureSize(source, 0) - 1;
  vec4 top = vec4(LEAST), total = vec4(0.0), sum = vec4(0.0);
#ifdef EDGE
  vec4 own = floatsAt(guides, here);
#endif
  ivec2 around[9];
#unroll k 9
  around[k] = clamp(here + ivec2(k % 3, k / 3) - 1, ivec2(0), last);
#end
#ifdef ADJACENT
  vec4 squares[9], guideSquares[9];
#unroll k 9
  squares[k] = floatsAt(source, around[k]);
#ifdef EDGE
  guideSquares[k] = floatsAt(guides, around[k]);
#endif
#end
#endif
#unroll group 7
  {
    vec4 x[9];
#unroll k 9
    x[k] = pixelAt(logits, around[k], (first + group) * tile.x);
#end
    mat4 weights, values; // a column is a tap of the four pixels
#unroll corner 4
    {
      const int side = 2 * (corner % 2), row = 6 * (corner / 2);
      weights[corner] = 0.5625 * x[4] + 0.1875 * (x[3 + side] + x[row + 1]) + 0.0625 * x[row + side];
    }
#end
    weights = transpose(weights);
#unroll k 4
    {
      const int number = min(4 * group + k, 24); // a 26th to 28th has no weight by its logit
      const ivec2 tap = ivec2(number % 5, number / 5);
      vec4 others;
#ifdef ADJACENT
#unroll corner 4
      {
        const ivec2 pixel = tap + ivec2(corner % 2, corner / 2); // from two to the upper left
        const int square = pixel.x / 2 + 3 * (pixel.y / 2), part = pixel.x % 2 + 2 * (pixel.y % 2);
        values[k][corner] = squares[square][part];
        others[corner] = guideSquares[square][part];
        if (around[square] != here + ivec2(square % 3, square / 3) - 1) weights[k][corner] = LEAST;
      }
#end
#else
      ivec2 place = here + dilation / 2 * (tap - 2), nearest = clamp(place, ivec2(0), last);
      values[k] = floatsAt(source, nearest);
      if (place != nearest) weights[k] = vec4(LEAST);
#ifdef EDGE
      others = floatsAt(guides, nearest);
#endif
#endif
#ifdef EDGE
      weights[k] = mix(vec4(LEAST), weights[k], lessThanEqual(abs(others - own), vec4(edge)));
#endif
    }
#end
    vec4 higher = max(top, max(max(weights[0], weights[1]), max(weights[2], weights[3])));
    total *= exp(top - higher);
    sum *= exp(top - higher);
    top = higher;
#unroll k 4
    weights[k] = exp(weights[k] - top);
    total += weights[k];
    sum += weights[k] * values[k];
#end
  }
#end
  filtered = bitsOf(sum / total);
}

// More rays from each pixel's centre to the light (frames/ray_tracing.py): x the mean of all so far, y
// the summed radii of blockers' penumbrae, z how many blocked, w how many in all.
uniform usampler2D before;
uniform vec3 centre;
uniform float sceneSize;
uniform float radius;
uniform int first, count; // rays before, and of this pass
uniform int whole;        // rays of a pixel if they are a spiral's, 0 if a sequence's (rendering/light_samples.py)
uniform bool penumbrae;   // asks for the first hits, not for any
uniform bool even;        // rays of neighbours are spread evenly (rendering/light_samples.py)
layout(location = 0) out uvec4 answer;

// Fractions of the plane's golden ratio, in 32 bits (Roberts 2018).
const uint SHARES = 3242174889u, TURNS = 2447445413u, SALT = 67108864u, SECTION = 2654435769u;

void main() {
  Receiver r;
  ivec2 at = ivec2(gl_FragCoord.xy);
  answer = bitsOf(vec4(1.0, 0.0, 0.0, 1.0));
  if (!receive(at, centre, r)) return;
  vec4 sums = first > 0 ? floatsAt(before, at) : vec4(0.0);
  float free = 0.0;
  vec3 start = r.p + 1e-4 * sceneSize * r.face, towards = centre - start;
  mat2x3 sides = sidesOf(normalize(towards));
  uint key = (uint(at.y * textureSize(points, 0).x + at.x) + SALT) * 16u;
  uint row = uint(at.y), column = uint(at.x);
  float turn = 6.283185307 * fraction(even ? SHARES * column + TURNS * row : hashed(key));
  uint shift = even ? TURNS * column - SHARES * row : hashed(key + 1u);
  for (int k = first; k < first + count; k++) {
    float share = whole > 0 ? (float(k) + fraction(shift)) / float(whole) : fraction(uint(k) * SHARES + SHARES / 2u + shift);
    float angle = turn + 6.283185307 * fraction(whole > 0 ? uint(k) * SECTION : uint(k) * TURNS + TURNS / 2u);
    vec3 way = towards + radius * sqrt(share) * (sides * vec2(cos(angle), sin(angle)));
    if (dot(r.face, way) <= 0.0) continue;
    float part = freeShare(start, way, !penumbrae);
    if (part >= NEARLY_ALL) free += 1.0;
    else sums.yz += vec2(radius * part / (1.0 - part), 1.0);
  }
  sums.x = (sums.x * sums.w + free) / (sums.w + float(count));
  sums.w += float(count);
  answer = bitsOf(sums);
}

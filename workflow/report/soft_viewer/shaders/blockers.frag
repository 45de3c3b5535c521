// Percentage-closer soft shadows (Fernando 2005), as shadow_maps/light_filters.py has them: a search
// for blockers, then a filter as wide as their penumbra. Discs of Vogel's spiral round the receiver.
uniform float radius; // of the light, metres
layout(location = 0) out uvec4 answer;

const float GOLDEN_ANGLE = 2.399963229728653;

// How many of a disc's texels are before the receiver's plane, and their summed depths.
vec2 blockers(Receiver r, mat2x3 sides, float angle, int samples, float bias) {
  vec3 direction = r.fromLight / r.z;
  vec2 sum = vec2(0.0);
  for (int k = 0; k < samples; k++) {
    float turn = float(k) * GOLDEN_ANGLE, length_ = angle * sqrt((float(k) + 0.5) / float(samples));
    vec2 place;
    int face = placeOf(direction + length_ * (sides * vec2(cos(turn), sin(turn))), place);
    ivec2 texel = clamp(ivec2(floor(place)), 0, resolution - 1);
    float depth = texelDepth(face, texel);
    vec3 towards = directionOf(face, vec2(texel) + 0.5);
    if (depth < planeDepth(towards, r.fromLight, r.face, bias)) sum += vec2(1.0, depth);
  }
  return sum;
}

void main() {
  Receiver r;
  answer = bitsOf(vec4(1.0));
  ivec2 at = ivec2(gl_FragCoord.xy);
  if (!receive(at, centre, r)) return;
  answer = bitsOf(vec4(0.0));
  if (r.cosine <= 0.0) return;
  // A golden ratio's multiple of the pixel's number, in 32 bits.
  float turn = 6.283185307 * fraction(uint(at.y * textureSize(points, 0).x + at.x) * 2654435769u);
  mat2x3 sides = sidesOf(r.fromLight / r.z) * mat2(cos(turn), sin(turn), -sin(turn), cos(turn));
  float bias = receiverBias(r.fromLight, r.cosine, 0.75);
  // Blockers from half of the receiver's distance on.
  vec2 found = blockers(r, sides, radius * (1.0 / (0.5 * r.z) - 1.0 / r.z), SEARCHED, bias);
  answer = bitsOf(vec4(1.0));
  if (found.x == 0.0) return;
  float blocker = found.y / found.x;
  float angle = max(radius * (r.z - blocker) / (r.z * blocker), 1.0 / float(resolution));
  answer = bitsOf(vec4(1.0 - blockers(r, sides, angle, FILTERED, bias).x / float(FILTERED)));
}

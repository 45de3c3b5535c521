// Moments filtered over a box of texels (evaluation/methods/moments.py).
uniform int taps;
uniform float biasScale;
uniform float bleeding;
layout(location = 0) out uvec4 answer;

void main() {
  Receiver r;
  answer = bitsOf(vec4(1.0));
  if (!receive(ivec2(gl_FragCoord.xy), centre, r)) return;
  float kernel[MOST_TAPS], spread = 0.0;
  for (int k = 0; k < taps; k++) {
    float offset = float(k - taps / 2);
    kernel[k] = 1.0 / float(taps);
    spread += kernel[k] * offset * offset;
  }
  float receiver = r.z - biasScale * receiverBias(r.fromLight, r.cosine, 0.75 + sqrt(spread));
  float share = momentVisibility(r.fromLight, max(receiver, 0.0), taps, kernel);
  answer = bitsOf(vec4(r.cosine > 0.0 ? max((share - bleeding) / (1.0 - bleeding), 0.0) : 0.0));
}

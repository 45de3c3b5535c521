// Percentage-closer filtering over taps × taps bilinear tests (shadow_maps/box_filter.py).
uniform int taps;
layout(location = 0) out uvec4 answer;

void main() {
  Receiver r;
  answer = bitsOf(vec4(1.0));
  if (!receive(ivec2(gl_FragCoord.xy), centre, r)) return;
  vec2 place;
  int face = placeOf(r.fromLight, place);
  ivec2 first = ivec2(floor(place - 0.5));
  vec2 share = place - 0.5 - vec2(first);
  first -= taps / 2;
  float bias = receiverBias(r.fromLight, r.cosine, 0.75), total = 0.0;
  for (int row = 0; row <= taps; row++) {
    float down = row == 0 ? 1.0 - share.y : row == taps ? share.y : 1.0;
    for (int column = 0; column <= taps; column++) {
      float right = column == 0 ? 1.0 - share.x : column == taps ? share.x : 1.0;
      vec3 direction;
      float depth = depthAt(face, first + ivec2(column, row), direction);
      total += down * right * float(depth >= planeDepth(direction, r.fromLight, r.face, bias));
    }
  }
  answer = bitsOf(vec4(r.cosine > 0.0 ? total / float(taps * taps) : 0.0));
}

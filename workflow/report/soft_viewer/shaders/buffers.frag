// The buffers of a frame, as frames/buffers.py has them; lengths in shares of the scene's size.
uniform vec3 eye;
layout(location = 0) out uvec4 lengths;      // z, gap, d; w 1 where there is a surface
layout(location = 1) out uvec4 visibilities; // c_e, c_v, hard, msm
layout(location = 2) out uvec4 pcf;          // x, by the four texels round the receiver

void main() {
  Receiver r;
  lengths = bitsOf(vec4(0.0));
  visibilities = bitsOf(vec4(0.0, 0.0, 1.0, 1.0));
  pcf = bitsOf(vec4(1.0, 0.0, 0.0, 0.0));
  if (!receive(ivec2(gl_FragCoord.xy), centre, r)) return;
  vec2 place;
  int face = placeOf(r.fromLight, place);
  float first = texelDepth(face, ivec2(floor(place)));
  float biased = r.z - receiverBias(r.fromLight, r.cosine, 0.75);
  float facing = float(r.cosine > 0.0), gap = first < EMPTY ? first - r.z : 0.0;
  lengths = bitsOf(vec4(vec3(r.z, gap, r.d) / sceneSize, 1.0));
  float kernel[MOST_TAPS];
  kernel[0] = kernel[2] = GAUSSIAN_SIDE;
  kernel[1] = 1.0 - 2.0 * GAUSSIAN_SIDE;
  visibilities = bitsOf(vec4(
    -dot(r.fromLight, r.n) / r.z, dot(eye - r.p, r.n) / r.d,
    facing * float(biased <= first), facing * momentVisibility(r.fromLight, r.z, 3, kernel)));
  ivec2 corner = ivec2(floor(place - 0.5));
  vec2 share = place - 0.5 - vec2(corner);
  vec3 unused;
  float tests[4];
  for (int k = 0; k < 4; k++) tests[k] = float(biased <= depthAt(face, corner + ivec2(k & 1, k >> 1), unused));
  pcf = bitsOf(vec4(facing * mix(mix(tests[0], tests[1], share.x), mix(tests[2], tests[3], share.x), share.y)));
}

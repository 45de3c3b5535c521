// The thesis's network [3.3]: frequency encoding and layers without biases, ReLU after each. A
// texel of `weights` is a column of a 4 × 4 block; blocks are in order of outputs, then inputs.
uniform sampler2D weights;
uniform float depthBias;

const int INPUTS = (6 * (1 + 2 * FREQUENCIES) + 3) / 4; // in fours, as all sizes here
int texel;

vec4 weight() {
  ivec2 place = ivec2(texel & 255, texel >> 8); // rows of 256: a division would take longer
  texel++;
  return texelFetch(weights, place, 0);
}

vec4 times(vec4 x) {
  vec4 sum = weight() * x.x;
  sum += weight() * x.y;
  sum += weight() * x.z;
  return sum + weight() * x.w;
}

float shadowDepth(vec3 o, vec3 d) {
  float rays[6] = float[6](o.x, o.y, o.z, d.x, d.y, d.z);
  vec4 x[INPUTS];
  for (int i = 0; i < INPUTS; i++) x[i] = vec4(0.0);
  for (int i = 0; i < 6; i++) {
    float value = (rays[i] + 1.0) / 2.0, turns = value / 2.0;
    x[i / 4][i % 4] = value;
    for (int k = 0; k < FREQUENCIES; k++, turns *= 2.0) {
      // 2ᵏ x is exact, and so is what is left of it in one turn; a sine of 2ᵏ π x is not.
      float phase = 6.283185307179586 * (turns - floor(turns));
      int sine = 6 + i * FREQUENCIES + k, cosine = sine + 6 * FREQUENCIES;
      x[sine / 4][sine % 4] = sin(phase);
      x[cosine / 4][cosine % 4] = cos(phase);
    }
  }
  vec4 h[WIDTH], next[WIDTH];
  texel = 0;
  for (int j = 0; j < WIDTH; j++) {
    vec4 sum = vec4(0.0);
    for (int i = 0; i < INPUTS; i++) sum += times(x[i]);
    h[j] = max(sum, 0.0);
  }
  for (int layer = 0; layer < HIDDEN_LAYERS; layer++) {
    for (int j = 0; j < WIDTH; j++) {
      vec4 sum = vec4(0.0);
      for (int i = 0; i < WIDTH; i++) sum += times(h[i]);
      next[j] = max(sum, 0.0);
    }
    h = next;
  }
  float t = 0.0;
  for (int i = 0; i < WIDTH; i++) t += dot(weight(), h[i]);
  return 2.0 * max(t, 0.0);
}

bool lit(vec3 p, vec3 light) {
  vec3 o;
  float s, chord;
  if (!sphereRay(p, light, o, s, chord)) return true;
  return min(s, chord) <= shadowDepth(o, -light) + depthBias;
}

// Moment shadow maps (Peters and Klein 2015), as shadow_maps/moments.py has them, in float32: moments are
// taken about the receiver's depth, where digits do not cancel. The bias towards (½, ½, ½, ½) is two more depths, 0
// and 1, of half its weight each.
const float MOMENT_BIAS = 3e-7;

void addDepth(float depth, float weight, float scale, inout vec4 moments) {
  float t = depth * scale, square = t * t;
  moments += weight * vec4(t, square, square * t, square * square);
}

// Visibility of a receiver at 0, by moments about it.
float hamburger(vec4 b, float scale) {
  float l32d22 = b.z - b.x * b.y, d22 = b.y - b.x * b.x, l32 = l32d22 / d22;
  float least = 1e-14 * scale * scale * scale * scale;
  float d33 = max(b.w - b.y * b.y - l32d22 * l32, least);
  float c1 = -b.x, c2 = (-b.y - l32 * c1) / d33;
  if (abs(c2) < 1e-9 / (scale * scale)) c2 = 1e-9 / (scale * scale);
  c1 = c1 / d22 - l32 * c2;
  float c0 = 1.0 - c1 * b.x - c2 * b.y;
  float middle = -0.5 * c1 / c2, product = c0 / c2;
  float half_ = sqrt(max(middle * middle - product, 0.0));
  float root = middle >= 0.0 ? middle + half_ : middle - half_;
  float other = root != 0.0 ? product / root : 0.0;
  float near = min(root, other), far = max(root, other), shadow;
  if (0.0 <= near) shadow = 0.0;
  else if (0.0 <= far) shadow = (b.y - b.x * far) / ((far - near) * -near);
  else shadow = 1.0 - (near * far - b.x * (near + far) + b.y) / (near * far);
  return 1.0 - clamp(shadow, 0.0, 1.0);
}

// taps: of the kernel, an odd number; kernel: their weights along an axis; receiver: its distance
// from the light, less its bias.
float momentVisibility(vec3 fromLight, float receiver, int taps, float kernel[MOST_TAPS]) {
  float span = 2.0 * sceneSize, depth = receiver / span, scale = 1.0 / SPREAD;
  vec2 place;
  int face = placeOf(fromLight, place);
  ivec2 first = ivec2(floor(place - 0.5));
  vec2 share = place - 0.5 - vec2(first);
  first -= taps / 2;
  vec4 moments = vec4(0.0);
  for (int row = 0; row <= taps; row++) {
    float down = (row < taps ? (1.0 - share.y) * kernel[row] : 0.0) + (row > 0 ? share.y * kernel[row - 1] : 0.0);
    for (int column = 0; column <= taps; column++) {
      float right = (column < taps ? (1.0 - share.x) * kernel[column] : 0.0)
        + (column > 0 ? share.x * kernel[column - 1] : 0.0);
      vec3 direction;
      float q = min(depthAt(face, first + ivec2(column, row), direction), span) / span;
      addDepth(q - depth, down * right, scale, moments);
    }
  }
  vec4 ends = vec4(0.0);
  addDepth(-depth, 0.5, scale, ends);
  addDepth(1.0 - depth, 0.5, scale, ends);
  return hamburger(mix(moments, ends, MOMENT_BIAS), scale);
}

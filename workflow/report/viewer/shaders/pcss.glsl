// Percentage-closer soft shadows (Fernando 2005): the blockers' mean height sets the filter's width.
const int SEARCHED = 16, FILTERED = 32; // texels of a pixel

// Evenly over a unit disc (Vogel 1979).
vec2 inDisc(int k, int count, float turn) {
  float angle = 2.399963229728653 * float(k) + turn;
  return sqrt((float(k) + 0.5) / float(count)) * vec2(cos(angle), sin(angle));
}

float blockerAt(vec2 seen) {
  vec2 texel = placeOf(seen);
  return onMap(texel) ? heightAt(ivec2(texel)) : -1e30;
}

vec2 visibility(vec3 p, vec3 n) {
  vec3 seen = p * basis, facing = n * basis;
  if (facing.z <= 0.0) return vec2(0.0, 1.0);
  float turn = 6.283185307179586 * noise().x, height = raised(seen.z, facing.z);
  vec2 tilt = -facing.xy / max(facing.z, 0.05); // of the face, so that it does not shadow itself
  float reach = slope * max(0.0, highest - seen.z), sum = 0.0, blockers = 0.0;
  for (int k = 0; k < SEARCHED; k++) {
    vec2 away = reach * inDisc(k, SEARCHED, turn);
    float blocker = blockerAt(seen.xy + away);
    if (blocker <= height + dot(tilt, away)) continue;
    sum += blocker;
    blockers++;
  }
  if (blockers == 0.0) return vec2(1.0);
  float width = slope * (sum / blockers - seen.z), lit = 0.0;
  for (int k = 0; k < FILTERED; k++) {
    vec2 away = width * inDisc(k, FILTERED, turn);
    if (blockerAt(seen.xy + away) <= height + dot(tilt, away)) lit++;
  }
  return vec2(lit / float(FILTERED), 1.0);
}

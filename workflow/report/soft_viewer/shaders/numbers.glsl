// Random numbers and directions across another, as rendering/light_samples.py has them.
uint hashed(uint x) { // lowbias32 (Wellons 2018)
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  return x ^ (x >> 16);
}

float fraction(uint x) { return float(x >> 8) / 16777216.0; }

void across(vec3 n, out vec3 u, out vec3 v) { // Duff et al. 2017
  float side = n.z >= 0.0 ? 1.0 : -1.0, a = -1.0 / (side + n.z), b = n.x * n.y * a;
  u = vec3(1.0 + side * n.x * n.x * a, side * b, -side * n.x);
  v = vec3(b, side + n.y * n.y * a, -n.y);
}

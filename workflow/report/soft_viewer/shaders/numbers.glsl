// Random numbers, as rendering/light_samples.py has them.
uint hashed(uint x) { // lowbias32 (Wellons 2018)
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  return x ^ (x >> 16);
}

float fraction(uint x) { return float(x >> 8) / 16777216.0; }

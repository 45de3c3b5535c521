// A light's disc.

// Unit vectors across a direction (Duff et al. 2017).
mat2x3 sidesOf(vec3 d) {
  float side = d.z >= 0.0 ? 1.0 : -1.0, a = -1.0 / (side + d.z), b = d.x * d.y * a;
  return mat2x3(1.0 + side * d.x * d.x * a, side * b, -side * d.x, b, side + d.y * d.y * a, -d.y);
}

// Share of a unit disc on its middle's side of a straight edge at m.
float halfDisc(float m) {
  m = clamp(m, -1.0, 1.0);
  return 1.0 - (acos(m) - m * sqrt(1.0 - m * m)) / 3.141592653589793;
}

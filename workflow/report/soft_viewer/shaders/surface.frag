// Surface points at pixel centres; see rendering/surface.py, whose frames these are.
in vec3 p;
in vec3 n;
flat in vec3 faceN;
flat in vec3 albedo;
flat in vec3 corner;
uniform vec3 eye;
uniform mat3 pixels; // from (column, row, 1), rows from below, to the ray through a place
uniform float height;
layout(location = 0) out uvec4 point;  // metres; w 1 where there is a surface
layout(location = 1) out uvec4 normal; // unit, on the camera's side; w distance from the eye
layout(location = 2) out uvec4 face;   // the triangle's unit normal, on the camera's side
layout(location = 3) out vec4 colour;

void main() {
  // Rasterisers put corners on a grid of 1/16 to 1/256 pixel, which on a thin rod is another normal: the
  // point is that of the pixel's own ray on the triangle's plane, and the normal follows it.
  vec3 ray = pixels * vec3(gl_FragCoord.x, height - gl_FragCoord.y, 1.0);
  vec3 exact = eye + dot(corner - eye, faceN) / dot(ray, faceN) * ray, x = dFdx(p), y = dFdy(p);
  mat2 squares = mat2(dot(x, x), dot(x, y), dot(x, y), dot(y, y));
  vec2 moved = vec2(dot(x, exact - p), dot(y, exact - p));
  vec2 steps = determinant(squares) > 0.0 ? clamp(inverse(squares) * moved, -0.5, 0.5) : vec2(0.0);
  vec3 followed = n + steps.x * dFdx(n) + steps.y * dFdy(n);
  vec3 seen = exact - eye;
  vec3 side = normalize(dot(faceN, seen) > 0.0 ? -faceN : faceN);
  vec3 smooth_ = dot(n, n) > 0.0 ? normalize(followed) : side;
  point = bitsOf(vec4(exact, 1.0));
  normal = bitsOf(vec4(dot(smooth_, side) < 0.0 ? -smooth_ : smooth_, length(seen)));
  face = bitsOf(vec4(side, 0.0));
  colour = vec4(albedo, 1.0);
}

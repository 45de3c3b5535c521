// Surface points and normals, for every method; see rendering/gbuffer.py, whose frames these are.
in vec3 p;
in vec3 n;
flat in vec3 faceN;
uniform vec3 eye;
uniform float kind; // 1 the object, 2 the ground
uniform float rim;  // |p|² where the ground ends
uniform mat3 pixels; // from (column, row, 1) to the ray through a pixel
uniform float drop;  // from the eye to the ground, along up, which is the ground's normal
layout(location = 0) out uvec4 point;        // moved by the shading offset; w: kind
layout(location = 1) out uvec4 faceNormal;   // on the camera's side
layout(location = 2) out vec4 shadingNormal; // on the face normal's side; w: 1

void main() {
  vec3 seen = p;
  if (kind == 2.0) {
    // Not p, which in a triangle of 80 radii is not exact to a pixel.
    vec3 ray = pixels * vec3(gl_FragCoord.xy, 1.0);
    seen = eye + drop / dot(ray, faceN) * ray;
    if (dot(seen, seen) >= rim) discard;
  }
  vec3 face = dot(faceN, seen - eye) > 0.0 ? -faceN : faceN;
  point = bitsOf(vec4(seen + SHADING_OFFSET * face, kind));
  faceNormal = bitsOf(vec4(face, 0.0));
  vec3 shading = dot(n, n) > 0.0 ? normalize(n) : face;
  shadingNormal = vec4(dot(shading, face) < 0.0 ? -shading : shading, 1.0);
}

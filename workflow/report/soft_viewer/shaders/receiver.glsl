// The pixel's surface point as a receiver of light.
uniform usampler2D points;
uniform usampler2D normals;
uniform usampler2D faces;

struct Receiver {
  vec3 p, n, face;  // metres; unit normals, interpolated and the triangle's
  float d;          // from the eye
  vec3 fromLight;
  float z, cosine;  // from the light; the triangle's normal with the direction to it
};

// False where there is no surface.
bool receive(ivec2 at, vec3 light, out Receiver r) {
  vec4 point = floatsAt(points, at), normal = floatsAt(normals, at);
  r.p = point.xyz;
  r.n = normal.xyz;
  r.d = normal.w;
  r.face = floatsAt(faces, at).xyz;
  r.fromLight = r.p - light;
  r.z = length(r.fromLight);
  r.cosine = -dot(r.fromLight, r.face) / r.z;
  return point.w > 0.0;
}

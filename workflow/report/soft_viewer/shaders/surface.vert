// The scene's surface points, as the camera sees them; texel rows from the picture's top.
in vec3 position;
in vec3 normal;
in vec3 faceNormal;
in vec3 tint;
uniform mat4 camera;
uniform mat4 motion;
out vec3 p;
out vec3 n;
flat out vec3 faceN;
flat out vec3 albedo;
flat out vec3 corner;

void main() {
  p = (motion * vec4(position, 1.0)).xyz;
  n = mat3(motion) * normal;
  faceN = mat3(motion) * faceNormal;
  albedo = tint;
  corner = p;
  gl_Position = camera * vec4(p, 1.0);
  gl_Position.y = -gl_Position.y;
}

// The object's and the ground's surface points, as the camera sees them.
in vec3 position;
in vec3 normal;
in vec3 faceNormal;
uniform mat4 camera;
out vec3 p;
out vec3 n;
flat out vec3 faceN;

void main() {
  p = position;
  n = normal;
  faceN = faceNormal;
  gl_Position = camera * vec4(position, 1.0);
}

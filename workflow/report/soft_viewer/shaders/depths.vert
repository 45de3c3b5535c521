// One face of a light's cube map: right, down and forward as clip space's x, y and depth.
in vec3 position;
in vec3 faceNormal;
uniform mat4 motion;
uniform vec3 centre;
uniform mat3 axes; // columns right, down, forward
uniform vec2 range; // near and far planes, metres
flat out vec3 corner;
flat out vec3 faceN;

void main() {
  corner = (motion * vec4(position, 1.0)).xyz - centre;
  faceN = mat3(motion) * faceNormal;
  vec3 place = corner * axes;
  float near = range.x, far = range.y;
  gl_Position = vec4(place.xy, (place.z * (far + near) - 2.0 * far * near) / (far - near), place.z);
}

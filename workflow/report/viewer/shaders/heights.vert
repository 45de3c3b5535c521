// A shadow map's depths, orthographic along the light; see shadow_maps/rasterise.py.
in vec3 position;
uniform mat3 basis;      // columns u, v, light
uniform vec3 corner;     // of the map's square, and the least height
uniform float side;
uniform float highest;
out float height;

void main() {
  vec3 seen = position * basis;
  height = seen.z;
  vec2 place = (seen.xy - corner.xy) / side;
  gl_Position = vec4(2.0 * place - 1.0, 2.0 * (highest - height) / (highest - corner.z) - 1.0, 1.0);
}

// A light's cube map, looked up by direction as shadow_maps/light_map.py has it: six faces of N × N
// texels in an atlas of 3 × 2; face 2 a + s looks along axis a, forwards for s = 0.
uniform usampler2D depths;
uniform int resolution;
uniform vec3 centre; // of the light, metres
uniform float sceneSize;

const float EMPTY = 1e30; // what a texel without a surface holds
const float MOST_SLOPE = 20.0;

// Face of a direction, and its place in texels: column, row.
int placeOf(vec3 v, out vec2 place) {
  vec3 a = abs(v);
  int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
  bool back = v[axis] < 0.0;
  vec2 across = vec2(v[(axis + 1) % 3], back ? -v[(axis + 2) % 3] : v[(axis + 2) % 3]);
  place = (0.5 * across / a[axis] + 0.5) * float(resolution);
  return 2 * axis + int(back);
}

vec3 directionOf(int face, vec2 place) {
  int axis = face / 2;
  float along = face % 2 == 0 ? 1.0 : -1.0;
  vec2 across = 2.0 * place / float(resolution) - 1.0;
  vec3 v;
  v[axis] = along;
  v[(axis + 1) % 3] = across.x;
  v[(axis + 2) % 3] = across.y * along;
  return v;
}

float texelDepth(int face, ivec2 texel) {
  ivec2 corner = resolution * ivec2(face % 3, face / 3);
  return floatsAt(depths, corner + clamp(texel, 0, resolution - 1)).r;
}

// Of a texel that may lie beyond its face's rim: there, of the face that goes on.
float depthAt(int face, ivec2 texel, out vec3 direction) {
  direction = directionOf(face, vec2(texel) + 0.5);
  if (texel == clamp(texel, 0, resolution - 1)) return texelDepth(face, texel);
  vec2 place;
  int other = placeOf(direction, place);
  ivec2 at = clamp(ivec2(floor(place)), 0, resolution - 1);
  direction = directionOf(other, vec2(at) + 0.5);
  return texelDepth(other, at);
}

// Depth bias of a receiver (shadow_maps/light_filters.py); reach: of the filter, in texels.
float receiverBias(vec3 fromLight, float cosine, float reach) {
  vec3 a = abs(fromLight);
  float texel = 2.0 / float(resolution) * max(a.x, max(a.y, a.z));
  float limited = clamp(cosine, 0.01, 1.0);
  float tangent = sqrt(1.0 / (limited * limited) - 1.0);
  return texel * min(0.5 + reach * tangent, MOST_SLOPE) + 1e-4 * sceneSize;
}

// Least distance of a texel's surface that is not before the receiver's plane
// (shadow_maps/light_discs.py); direction: through the texel's middle.
float planeDepth(vec3 direction, vec3 fromLight, vec3 normal, float bias) {
  float distance_ = length(fromLight), facing = dot(normal, fromLight) / distance_;
  float ratio = abs(facing) >= 1e-3 ? dot(normal, normalize(direction)) / facing : 1.0;
  return distance_ / clamp(ratio, 0.5, 2.0) - bias;
}

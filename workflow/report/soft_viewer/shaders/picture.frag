// One method's answer as a picture: the shaded scene, the visibility alone, or where it is wrong. Surfaces are as
// fine as the picture; the answer may be coarser, and is taken from those of its four pixels around that
// lie on the same surface.
uniform usampler2D points;
uniform usampler2D normals;
uniform sampler2D colours;
uniform usampler2D coarsePoints;
uniform usampler2D coarseNormals;
uniform usampler2D answer;
uniform usampler2D reference;
uniform vec4 channel; // of the answer: one is 1
uniform vec3 centre;
uniform int look; // 0 shaded, 1 visibility, 2 error
layout(location = 0) out vec4 colour;

const vec3 SKY = vec3(0.30, 0.33, 0.38), FLOOR = vec3(0.15, 0.135, 0.12), SUN = vec3(0.86, 0.80, 0.70);
const vec3 BACKGROUND = vec3(0.80, 0.84, 0.88);

vec3 display(vec3 linear) { return pow(clamp(linear, 0.0, 1.0), vec3(1.0 / 2.2)); }

// The answer and the reference at a surface point.
vec2 visibilityAt(vec2 share, vec3 p, vec4 normal) {
  ivec2 size = textureSize(coarsePoints, 0);
  vec2 place = share * vec2(size) - 0.5, part = fract(place);
  vec3 sum = vec3(0.0);
  for (int k = 0; k < 4; k++) {
    ivec2 step_ = ivec2(k & 1, k >> 1), at = clamp(ivec2(floor(place)) + step_, ivec2(0), size - 1);
    vec4 point = floatsAt(coarsePoints, at);
    vec2 near = mix(1.0 - part, part, vec2(step_));
    float off = abs(dot(point.xyz - p, normal.xyz)) / normal.w; // from the plane, in shares of the eye's distance
    float alike = max(dot(floatsAt(coarseNormals, at).xyz, normal.xyz), 0.0);
    float weight = (near.x * near.y + 1e-3) * (point.w * alike * exp(-300.0 * off) + 1e-5);
    sum += weight * vec3(dot(floatsAt(answer, at), channel), floatsAt(reference, at).x, 1.0);
  }
  return clamp(sum.xy / sum.z, 0.0, 1.0);
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec4 point = floatsAt(points, at), normal = floatsAt(normals, at);
  colour = vec4(BACKGROUND, 1.0);
  if (point.w == 0.0) return;
  vec2 visible = visibilityAt(gl_FragCoord.xy / vec2(textureSize(points, 0)), point.xyz, normal);
  float lambert = max(dot(normal.xyz, normalize(centre - point.xyz)), 0.0);
  vec3 ambient = mix(FLOOR, SKY, 0.5 + 0.5 * normal.y);
  colour.rgb = display(texelFetch(colours, at, 0).rgb * (ambient + SUN * lambert * visible.x));
  if (look == 1) colour.rgb = vec3(visible.x);
  if (look != 2) return;
  float wrong = visible.x - visible.y;
  vec3 hue = wrong < 0.0 ? vec3(0.835, 0.369, 0.0) : vec3(0.0, 0.447, 0.698);
  float grey = dot(colour.rgb, vec3(0.3, 0.6, 0.1));
  colour.rgb = mix(vec3(0.6 + 0.35 * grey), hue, min(2.0 * abs(wrong), 1.0));
}

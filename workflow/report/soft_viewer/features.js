// Inputs of screen-space networks, as frames/features.py and frames/kernel_features.py have them: GLSL of
// the shared buffers, written for a network's list of features.

// By name: the planes of a feature, each an expression of what `FEATURE_HEAD` declares.
const FEATURE_PLANES = {
  c_e: ["(clamp(cosine, 0.0, 1.0) + lightStep) / 5.0"],
  view: ["clamp(cosineEye / max(d * axis, 0.05), 0.0, 10.0)"],
  ratio: ["signedLog(200.0 * clamp(gap / max(z, 1e-6), -1.0, 1.0))"],
  difference: ["signedLog(500.0 * clamp(gap, -2.0, 2.0))"],
  d: ["d * axis"],
  n: ["n.x", "n.y", "n.z"],
  z: ["z + gap"],
  z_f: ["z"],
  c_c: ["cosineEye"],
  cosine: ["cosine"],
  c_v_by_d: ["cosineEye / (d + 1e-10)"],
  penumbra: ["shown(framePixels((z - zBlocker) * share / (zBlocker + 1e-5), slant))"],
  penumbra_pcss: ["shown(framePixels((z - zBlocker) * share / (zBlocker + 1e-5), 1.0))"],
  behind: ["z - zBlocker"],
  z_b_by_z: ["zBlocker / (z + 1e-10)"],
  z_b: ["zBlocker"],
  r_e: ["lightStep / 4.0"],
  ray_penumbra: ["shown(framePixels(max(rayPenumbra, 0.0), slant))"],
  log_d: ["log(max(d, 1e-3))"],
  base_hard: ["hard"],
  base_pcf: ["floatsAt(pcf, at).x"],
  base_msm: ["msm"],
  base_rays: ["floatsAt(traced, at).x"],
};
const RAY_FEATURES = ["ray_penumbra", "base_rays"];
const MAP_FEATURES = [
  ...["ratio", "difference", "z", "penumbra", "penumbra_pcss", "behind", "z_b_by_z", "z_b", "base_hard", "base_pcf", "base_msm"],
];

const planeNames = (features) => features.flatMap((name) => FEATURE_PLANES[name]);

function featureShader(features) {
  const expressions = planeNames(features), map = features.some((name) => MAP_FEATURES.includes(name));
  const rays = features.some((name) => RAY_FEATURES.includes(name)), pcf = features.includes("base_pcf");
  const layers = Array.from({ length: Math.ceil(expressions.length / 4) }, (_, k) => expressions.slice(4 * k, 4 * k + 4));
  const outputs = layers.map((_, k) => `layout(location = ${k}) out uvec4 plane${k};`).join("\n");
  const writes = layers.map((layer, k) => `plane${k} = bitsOf(vec4(${[...layer, ...Array(4 - layer.length).fill("0.0")].join(", ")}));`);
  return `
uniform usampler2D points, normals;
${map ? "uniform usampler2D lengths, visibilities;" : ""}
${pcf ? "uniform usampler2D pcf;" : ""}
${rays ? "uniform usampler2D traced;" : ""}
uniform vec3 eye, forward, centre;
uniform float sceneSize, share, lightStep, focal;
${outputs}

float signedLog(float x) { return sign(x) * log(1.0 + abs(x)); }
float shown(float pixels) { return clamp(pixels, 0.0, 50.0) / 50.0; }

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec4 point = floatsAt(points, at), normal = floatsAt(normals, at);
  bool surface = point.w > 0.0;
  vec3 n = surface ? normal.xyz : vec3(0.0), seen = point.xyz - eye, fromLight = point.xyz - centre;
  float d = surface ? normal.w / sceneSize : 0.0, axis = surface ? dot(seen, forward) / normal.w : 1.0;
  float z = surface ? length(fromLight) / sceneSize : 0.0;
  float cosine = surface ? -dot(fromLight, n) / length(fromLight) : 0.0;
  float cosineEye = surface ? -dot(seen, n) / normal.w : 0.0;
  ${map ? `vec4 visibility = floatsAt(visibilities, at);
  float gap = floatsAt(lengths, at).y, hard = visibility.z, msm = visibility.w;
  float zBlocker = z + (hard > 0.5 ? 0.0 : min(gap, 0.0));` : ""}
  ${rays ? `vec4 sums = floatsAt(traced, at);
  float rayPenumbra = sums.z > 0.0 ? sums.y / sums.z / sceneSize : -1.0;` : ""}
  float slant = sqrt(abs(cosineEye) / (abs(cosine) + 1e-5)), pixels = 2048.0 * focal / 983.5 / max(d, 1e-5);
#define framePixels(blurred, by) ((blurred) * pixels * (by))
  ${writes.join("\n  ")}
}`;
}

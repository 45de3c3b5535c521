// The whole state in the address, so that a link shows what its sender saw.

const MOST_SUN = 5; // degrees across

const joined = (vector) => vector.map((x) => x.toFixed(4)).join(",");
const parted = (text) => text.split(",").map(Number);
const isVector = (text) => /^(-?\d+(\.\d+)?,){2}-?\d+(\.\d+)?$/.test(text ?? "");

function stateText({ left, right, divider, errors, sun, view, light }) {
  return new URLSearchParams({
    left, right, divider: divider.toFixed(1), ...(errors && { errors: "1" }), ...(sun && { sun }),
    eye: joined(view.eye), target: joined(view.target), fov: view.fov, light: joined(light),
  }).toString();
}

// What of a text makes sense; the rest stays as it was.
const isWay = (a, b = [0, 0, 0]) => Math.hypot(...plus(a, b, -1)) > 0.01;
function stateOf(text, keys) {
  const found = new URLSearchParams(text), state = {};
  for (const side of ["left", "right"]) if (keys.includes(found.get(side))) state[side] = found.get(side);
  const divider = Number(found.get("divider") ?? NaN), fov = Number(found.get("fov"));
  if (divider >= 0 && divider <= 100) state.divider = divider;
  if (found.size) state.errors = found.has("errors");
  const sun = Number(found.get("sun") ?? 0);
  if (found.size && sun >= 0 && sun <= MOST_SUN) state.sun = sun;
  const [light, eye, target] = ["light", "eye", "target"].map((name) => found.get(name));
  if (isVector(light) && isWay(parted(light))) state.light = parted(light);
  if (isVector(eye) && isVector(target) && isWay(parted(eye), parted(target)) && fov >= 5 && fov <= 120) {
    state.view = { eye: parted(eye), target: parted(target), fov };
  }
  return state;
}

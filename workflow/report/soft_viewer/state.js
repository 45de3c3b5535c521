// All that a reader chooses, as text in the address, so that a link shows what its sender saw.

const LOOKS = ["shaded", "visibility", "error"];
const numbers = (vector) => vector.map((x) => x.toFixed(3)).join(",");
const parsed = (text, count) => {
  const values = (text ?? "").split(",").map(Number);
  return values.length === count && values.every(Number.isFinite) ? values : null;
};

function stateText({ left, right, divider, look, view, light, move }) {
  return new URLSearchParams({
    left, right, divider: divider.toFixed(1), look, eye: numbers(view.eye), target: numbers(view.target),
    fov: view.fov, light: numbers(light.centre), radius: light.radius.toFixed(4), object: numbers(move),
  }).toString();
}

// What of a text makes sense; the rest stays as it was.
function stateOf(text, keys, largest) {
  const values = new URLSearchParams(text), state = {};
  for (const side of ["left", "right"]) if (keys.includes(values.get(side))) state[side] = values.get(side);
  const [divider, fov, radius] = ["divider", "fov", "radius"].map((name) => Number(values.get(name) ?? NaN));
  if (divider >= 0 && divider <= 100) state.divider = divider;
  if (LOOKS.includes(values.get("look"))) state.look = values.get("look");
  const eye = parsed(values.get("eye"), 3), target = parsed(values.get("target"), 3);
  if (eye && target && Math.hypot(...plus(eye, target, -1)) > 0.01 && fov >= 5 && fov <= 120) state.view = { eye, target, fov };
  const centre = parsed(values.get("light"), 3), move = parsed(values.get("object"), 3);
  // As `stateText` rounds it.
  if (centre && radius >= 0 && radius <= largest + 0.5e-4) state.light = { centre, radius: Math.min(radius, largest) };
  if (move) state.move = move;
  return state;
}

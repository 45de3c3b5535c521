// Vectors are arrays of three numbers, matrices of 16 by columns.

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const plus = (a, b, factor = 1) => a.map((x, i) => x + factor * b[i]);
const cross = (a, b) => [
  a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0],
];
const unit = (a) => a.map((x) => x / Math.hypot(...a));
const clamped = (x, low, high) => Math.min(high, Math.max(low, x));

// Rows u, v, along: of a light, as scenes/lights.py has it, or of any direction.
function basisOf(along) {
  const sizes = along.map(Math.abs), least = sizes.indexOf(Math.min(...sizes));
  const u = unit(cross([0, 1, 2].map((i) => Number(i === least)), along));
  return [u, cross(along, u), along];
}

// Rows right, upward, forward of a viewpoint's camera (scenes/cameras.py).
function cameraAxes({ eye, target, up }) {
  const forward = unit(plus(target, eye, -1)), right = unit(cross(forward, up));
  return [right, cross(right, forward), forward];
}

// From (column, row, 1), rows from below, to the ray through that place in the frame.
function pixelMatrix(view, width, height) {
  const [right, upward, forward] = cameraAxes(view), half = Math.tan(view.fov * Math.PI / 360);
  const corner = plus(plus(forward, right, -half * width / height), upward, -half);
  const pixel = 2 * half / height;
  return [...right.map((x) => x * pixel), ...upward.map((x) => x * pixel), ...corner];
}

// From normalised space to the clip space of a viewpoint's camera.
function cameraMatrix(view, aspect) {
  const { eye, fov } = view, [right, upward, forward] = cameraAxes(view);
  const scale = 1 / Math.tan(fov * Math.PI / 360);
  const near = 0.02, far = 60; // the ground ends at 20
  const rows = [
    [...right.map((x) => x * scale / aspect), -dot(right, eye) * scale / aspect],
    [...upward.map((x) => x * scale), -dot(upward, eye) * scale],
    [...forward.map((x) => x * (far + near) / (far - near)),
      -dot(forward, eye) * (far + near) / (far - near) - 2 * far * near / (far - near)],
    [...forward, -dot(forward, eye)],
  ];
  return [0, 1, 2, 3].flatMap((column) => rows.map((row) => row[column]));
}

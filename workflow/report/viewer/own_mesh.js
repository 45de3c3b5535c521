// A reader's mesh made ready: of few enough triangles, upright, in the unit sphere.

const MOST_TRIANGLES = 400_000; // in some seconds their tree is built

// Vertices in one cell of a grid are merged into their mean, on the finest grid that is coarse enough.
function reduced(mesh) {
  let small = mesh;
  for (let cells = 1024; small.faces.length > 3 * MOST_TRIANGLES; cells /= 1.26) small = clustered(mesh, cells);
  return small;
}

function clustered({ vertices, faces }, cells) {
  const { low, side } = boxOf(vertices), sums = [], counts = [], numbers = new Map();
  const merged = Uint32Array.from({ length: vertices.length / 3 }, (_, i) => {
    const place = [0, 1, 2].map((axis) => vertices[3 * i + axis]);
    const [x, y, z] = place.map((value, axis) => Math.floor((value - low[axis]) / side * cells));
    const key = (x * 2048 + y) * 2048 + z, number = numbers.get(key) ?? counts.length;
    if (number === counts.length) {
      numbers.set(key, number);
      counts.push(0);
      sums.push(0, 0, 0);
    }
    counts[number]++;
    place.forEach((value, axis) => { sums[3 * number + axis] += value; });
    return number;
  });
  const kept = [];
  for (let i = 0; i < faces.length; i += 3) {
    const [a, b, c] = [0, 1, 2].map((k) => merged[faces[i + k]]);
    if (a !== b && b !== c && c !== a) kept.push(a, b, c);
  }
  return { vertices: sums.map((sum, i) => sum / counts[Math.floor(i / 3)]), faces: kept };
}

function boxOf(vertices) {
  const low = [Infinity, Infinity, Infinity], high = low.map((x) => -x);
  for (let i = 0; i < vertices.length; i++) {
    low[i % 3] = Math.min(low[i % 3], vertices[i]);
    high[i % 3] = Math.max(high[i % 3], vertices[i]);
  }
  return { low, high, side: Math.max(...plus(high, low, -1)) || 1 };
}

// Turned so that its axis (0 to 2) is up, in the unit sphere about the middle of its box; its lowest
// height along `up`.
function upright({ vertices, faces }, axis, up) {
  const { low, high } = boxOf(vertices), middle = plus(low, high).map((x) => x / 2);
  const rows = basisOf(up), placed = new Float32Array(vertices.length);
  let radius = 0, ground = Infinity;
  for (let i = 0; i < vertices.length; i += 3) {
    const [x, y, z] = [1, 2, 3].map((k) => vertices[i + (axis + k) % 3] - middle[(axis + k) % 3]);
    const place = plus(plus(rows[0].map((a) => a * x), rows[1], y), rows[2], z);
    placed.set(place, i);
    radius = Math.max(radius, Math.hypot(x, y, z));
    ground = Math.min(ground, z);
  }
  for (let i = 0; i < placed.length; i++) placed[i] /= radius;
  return { vertices: placed, faces: Uint32Array.from(faces), ground: ground / radius };
}

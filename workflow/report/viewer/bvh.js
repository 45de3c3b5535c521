// A tree of boxes over triangles, for the rays of ray.glsl: split where the surface areas of the
// two sides, times their triangles, are least of BINS places along the longest axis.

const BINS = 16, LEAF = 4;

// positions: (triangles · 9). Gives nodes (8 numbers each) and the triangles in the leaves' order.
function buildTree(positions) {
  const count = positions.length / 9, order = Uint32Array.from({ length: count }, (_, i) => i);
  const low = new Float32Array(3 * count), high = new Float32Array(3 * count);
  for (let i = 0; i < count; i++) {
    for (let axis = 0; axis < 3; axis++) {
      const at = 9 * i + axis, [a, b, c] = [positions[at], positions[at + 3], positions[at + 6]];
      low[3 * i + axis] = Math.min(a, b, c);
      high[3 * i + axis] = Math.max(a, b, c);
    }
  }
  const nodes = [];

  function boxOf(first, end) {
    const box = [Infinity, Infinity, Infinity, -Infinity, -Infinity, -Infinity];
    for (let k = first; k < end; k++) grow(box, order[k]);
    return box;
  }
  function grow(box, i) {
    for (let axis = 0; axis < 3; axis++) {
      box[axis] = Math.min(box[axis], low[3 * i + axis]);
      box[axis + 3] = Math.max(box[axis + 3], high[3 * i + axis]);
    }
  }
  function area(box) {
    const [x, y, z] = [0, 1, 2].map((axis) => Math.max(0, box[axis + 3] - box[axis]));
    return x * y + y * z + z * x;
  }

  // Where to part order[first, end), already brought in order; or first for a leaf.
  function split(first, end, box) {
    const sizes = [0, 1, 2].map((axis) => box[axis + 3] - box[axis]);
    const axis = sizes.indexOf(Math.max(...sizes));
    const middle = (i) => (low[3 * i + axis] + high[3 * i + axis]) / 2;
    const bin = (i) => Math.min(BINS - 1, Math.floor((middle(i) - box[axis]) / sizes[axis] * BINS));
    const boxes = Array.from({ length: BINS }, () => boxOf(0, 0)), counts = new Uint32Array(BINS);
    for (let k = first; k < end; k++) {
      const place = bin(order[k]) || 0;
      counts[place]++;
      grow(boxes[place], order[k]);
    }
    const joined = (a, b) => a.map((x, i) => (i < 3 ? Math.min : Math.max)(x, b[i]));
    const costs = new Float64Array(BINS);
    for (const backward of [false, true]) {
      let whole = boxOf(0, 0), held = 0;
      for (let k = 1; k < BINS; k++) {
        const place = backward ? BINS - k : k - 1;
        whole = joined(whole, boxes[place]);
        held += counts[place];
        costs[backward ? place : k] += held ? area(whole) * held : 0;
      }
    }
    let best = 0;
    for (let k = 1, left = 0; k < BINS; k++) {
      left += counts[k - 1];
      if (left > 0 && left < end - first && (!best || costs[k] < costs[best])) best = k;
    }
    if (!best) return end - first > LEAF ? (first + end) >> 1 : first; // all in one place
    const part = order.slice(first, end), right = part.filter((i) => bin(i) >= best);
    const left = part.filter((i) => bin(i) < best);
    order.set(left, first);
    order.set(right, first + left.length);
    return first + left.length;
  }

  const open = [[0, count]]; // the last first, so that a node's first child follows it
  const ends = []; // of the nodes whose subtree is not yet whole: [node, its last triangle]
  while (open.length) {
    const [first, end] = open.pop(), box = boxOf(first, end), node = nodes.length / 8;
    while (ends.length && ends.at(-1)[1] <= first) nodes[8 * ends.pop()[0] + 3] = node;
    nodes.push(...box.slice(0, 3), 0, ...box.slice(3), 0);
    ends.push([node, end]);
    const middle = end - first > LEAF ? split(first, end, box) : first;
    if (middle === first) nodes[8 * node + 7] = 8 * first + end - first;
    else open.push([middle, end], [first, middle]);
  }
  for (const [node] of ends) nodes[8 * node + 3] = nodes.length / 8;
  const triangles = new Float32Array(12 * count);
  order.forEach((i, at) => {
    for (let k = 0; k < 3; k++) {
      triangles.set(positions.subarray(9 * i + 3 * k, 9 * i + 3 * k + 3), 12 * at + 4 * k);
    }
  });
  return { nodes: Float32Array.from(nodes), triangles };
}

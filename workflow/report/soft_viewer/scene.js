// The scene in metres: what stays and what moves, each as triangles and as a tree of boxes.

const TINTS = [[0.78, 0.76, 0.72], [0.72, 0.62, 0.50], [0.55, 0.63, 0.70], [0.70, 0.55, 0.50], [0.60, 0.66, 0.55], [0.74, 0.70, 0.58]];

// data: `objects`, the `mover`'s index, `size`. An object has its mesh (viewer/mesh_arrays.py) in its box: `middle` and
// `half`, metres. fields: of the closed objects (viewer/field_arrays.py), null for others.
async function unpackScene(data, { cell, samples_per_cell: samplesPerCell, objects: fields }) {
  const objects = await Promise.all(data.objects.map(async ({ mesh, middle, half }, i) => {
    const { vertices, faces } = await unpackMesh(mesh);
    for (let k = 0; k < vertices.length; k++) vertices[k] = vertices[k] * half + middle[k % 3];
    const { positions, vertexNormals, faceNormals } = corners({ vertices, faces });
    const tint = TINTS[i % TINTS.length];
    return { position: positions, normal: vertexNormals, faceNormal: faceNormals, moves: i === data.mover,
      tint: Float32Array.from(positions, (_, k) => tint[k % 3]), field: fields[i] && await unpackField(fields[i]) };
  }));
  const part = (chosen) => {
    const names = ["position", "normal", "faceNormal", "tint"];
    return Object.fromEntries(names.map((name) => [name, joinedArrays(chosen.map((object) => object[name]))]));
  };
  const moving = objects.filter(({ moves }) => moves), staying = objects.filter(({ moves }) => !moves);
  const open = (all) => joinedArrays(all.filter(({ field }) => !field).map(({ position }) => position));
  return {
    ...data, cell, samplesPerCell, moving: part(moving), staying: part(staying), rest: middleOf(moving[0].position),
    openMoving: open(moving), openStaying: open(staying), // triangles of objects without a field
    fields: objects.filter(({ field }) => field).map(({ field, moves }) => ({ ...field, moves })),
  };
}

async function unpackField(field) {
  const names = Object.keys(field.arrays), arrays = await Promise.all(names.map((name) => unpack(field.arrays[name])));
  const stored = names.reduce((sum, name) => sum + field.arrays[name].data.length * 3 / 4, 0);
  return { ...field, stored, arrays: Object.fromEntries(names.map((name, i) => [name, arrays[i]])) };
}

function joinedArrays(arrays) {
  const whole = new Float32Array(arrays.reduce((sum, array) => sum + array.length, 0));
  let at = 0;
  for (const array of arrays) {
    whole.set(array, at);
    at += array.length;
  }
  return whole;
}

// The middle of a box's floor: about it an object turns.
function middleOf(positions) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  positions.forEach((x, k) => {
    low[k % 3] = Math.min(low[k % 3], x);
    high[k % 3] = Math.max(high[k % 3], x);
  });
  return [(low[0] + high[0]) / 2, low[1], (low[2] + high[2]) / 2];
}

// Matrix (16, by columns) of an object's turn about the vertical through `rest` and its shift on the
// floor, and its inverse. move: shift along x and z in metres, turn in radians.
function motionOf(rest, [x, z, turn]) {
  const c = Math.cos(turn), s = Math.sin(turn);
  const rotation = (sine) => [c, 0, -sine, 0, 0, 1, 0, 0, sine, 0, c, 0];
  const turned = ([a, b, d], sine) => [c * a + sine * d, b, -sine * a + c * d];
  const shift = plus([rest[0] + x, rest[1], rest[2] + z], turned(rest, s), -1);
  const back = turned(shift, -s).map((value) => -value);
  return { forwards: [...rotation(s), ...shift, 1], backwards: [...rotation(-s), ...back, 1] };
}

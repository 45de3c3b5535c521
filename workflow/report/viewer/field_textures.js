// Textures of fields in bricks, as viewer/field_arrays.py packs them.

const ROW_BRICKS = 32; // of the values' texture: 4,000 texels; most phones end at 4,096
const SOLID = -(1 << 20); // in the grid: a brick that the surface encloses

// Uniforms of field_values.glsl. Numbers of bricks, and of cells that a ray may skip, are in the grid.
function fieldTextures(gl, { bricks: size, arrays }) {
  const grid = Int32Array.from(arrays.grid);
  let bricks = 0;
  grid.forEach((code, i) => { grid[i] = code === 0 ? bricks++ : code === 255 ? SOLID : -code; });
  return {
    grid: makeTexture(gl, ["R32I", "RED_INTEGER", "INT"], [size, size, size], grid),
    values: makeTable(gl, ["R8I", "RED_INTEGER", "BYTE"], 1,
      brickValues(grid, size, bricks, arrays.values), 125 * ROW_BRICKS),
  };
}

// More uniforms, of cones.glsl, where values are distances.
function coneUniforms(gl, { bricks: size, arrays, unit, push, step }) {
  const distances = summed(arrays.around, size + 1).map((steps) => steps * step);
  return { around: makeTexture(gl, ["R32F", "RED", "FLOAT"], Array(3).fill(size + 1), distances), unit, push };
}

// The 125 values of each brick, from those of all vertices, which bricks share, in order of place.
function brickValues(grid, size, bricks, values) {
  const whole = 4 * size + 1, count = 125 * bricks, found = new Int8Array(count);
  const places = new Uint32Array(count);
  grid.forEach((brick, i) => {
    if (brick < 0) return;
    const x = 4 * Math.floor(i / size / size), y = 4 * (Math.floor(i / size) % size), z = 4 * (i % size);
    for (let k = 0; k < 125; k++) {
      const row = (x + Math.floor(k / 25)) * whole + y + Math.floor(k / 5) % 5;
      places[125 * brick + k] = row * whole + z + k % 5;
    }
  });
  const sorted = places.slice().sort().filter((place, i, all) => i === 0 || place !== all[i - 1]);
  places.forEach((place, at) => {
    let low = 0, high = sorted.length - 1;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (sorted[middle] < place) low = middle + 1;
      else high = middle;
    }
    found[at] = values[low];
  });
  return found;
}

// Numbers in a cube from their zigzag differences along all three axes.
function summed(zigzags, side) {
  const numbers = Float32Array.from(zigzags, signed);
  for (const stride of [1, side, side * side]) {
    for (let i = 0; i < numbers.length; i++) {
      if (Math.floor(i / stride) % side) numbers[i] += numbers[i - stride];
    }
  }
  return numbers;
}

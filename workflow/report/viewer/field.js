// Occupancy fields as viewer/network_arrays.py writes them: rays through one, and cones where its
// values are distances.

const SOLID = -(1 << 20); // in the grid: a brick that the surface encloses
const ROW_BRICKS = 32; // of the values' texture: 4,000 texels; most phones end at 4,096

function fieldMethod(data) {
  const size = data.bricks, constants = { SOLID, ROW_BRICKS, SAMPLES_PER_CELL: `${data.samples_per_cell}.0` };
  let textures = null;
  const texturesOf = (gl) => {
    if (textures) return textures;
    const grid = Int32Array.from(data.arrays.grid);
    let bricks = 0;
    grid.forEach((code, i) => { grid[i] = code === 0 ? bricks++ : code === 255 ? SOLID : -code; });
    return textures = {
      grid: makeTexture(gl, ["R32I", "RED_INTEGER", "INT"], [size, size, size], grid),
      values: makeTable(gl, ["R8I", "RED_INTEGER", "BYTE"], 1,
        brickValues(grid, size, bricks, data.arrays.values), 125 * ROW_BRICKS),
    };
  };
  const cones = {
    ...data, key: `${data.key}_cones`, constants, sources: ["field_values", "cones"],
    underSun: "one walk to the sun, split into 8 where it is partly covered",
    make({ gl }) {
      const distances = summed(data.arrays.around, size + 1).map((steps) => steps * data.step);
      const around = makeTexture(gl, ["R32F", "RED", "FLOAT"], Array(3).fill(size + 1), distances);
      return () => ({ ...texturesOf(gl), around, unit: data.unit, push: data.push });
    },
  };
  return {
    ...data, constants, sources: ["sun_rays", "unit_sphere", "field_values", "field"], rays: true, ofShipped: true,
    soft: data.arrays.around && cones,
    make({ gl }) {
      const values = { level: data.level, depthBias: data.depth_bias, sheet: data.surface === "sheet" };
      return () => ({ ...texturesOf(gl), ...values });
    },
  };
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

// What can answer which points are lit. Each method has a key, a name, what it keeps in bytes, and
// what its shader is told; those made for a light (maps) are made anew when it moves.

const MAP_SIZES = [64, 128, 256, 512, 1024, 2048, 4096];
const SOLID = -(1 << 20); // in the grid: a brick that the surface encloses
const ROW_BRICKS = 32; // of the values' texture: 4,000 texels; most phones end at 4,096

function mapMethod(size, filtered) {
  return {
    key: `${filtered ? "pcf" : "map"}_${size}`,
    name: `Shadow map ${size}²${filtered ? ", 2 × 2 PCF" : ""}`,
    source: "map",
    resident: 4 * size * size,
    size, // of the map that is drawn for each light
    make: (renderer) => ({ uniforms: (light) => ({ ...renderer.mapOf(light, size), filtered }) }),
  };
}

const noShadow = {
  key: "no_shadow", name: "No shadow", source: "no_shadow", resident: 0,
  make: () => ({ uniforms: () => ({}) }),
};

const reference = {
  key: "reference", name: "Ray traced (reference)", source: "ray",
  make(renderer) {
    const { gl } = renderer, { nodes, triangles } = buildTree(renderer.positions);
    const format = ["RGBA32F", "RGBA", "FLOAT"];
    const told = {
      nodes: makeTable(gl, format, 4, nodes), triangles: makeTable(gl, format, 4, triangles),
      nodeCount: nodes.length / 8,
    };
    return { uniforms: () => told };
  },
};

function fieldMethod(data) {
  return {
    ...data, source: "field",
    constants: { SOLID, ROW_BRICKS, SAMPLES_PER_CELL: `${data.samples_per_cell}.0` },
    make({ gl }) {
      const size = data.bricks, grid = Int32Array.from(data.arrays.grid);
      let bricks = 0;
      grid.forEach((code, i) => { grid[i] = code === 0 ? bricks++ : code === 255 ? SOLID : -code; });
      const told = {
        grid: makeTexture(gl, ["R32I", "RED_INTEGER", "INT"], [size, size, size], grid),
        values: makeTable(gl, ["R8I", "RED_INTEGER", "BYTE"], 1,
          brickValues(grid, size, bricks, data.arrays.values), 125 * ROW_BRICKS),
        level: data.level, depthBias: data.depth_bias, sheet: data.surface === "sheet",
      };
      return { uniforms: () => told };
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

function networkMethod(data) {
  return {
    ...data, source: "network",
    constants: {
      FREQUENCIES: data.frequencies, WIDTH: data.width / 4, HIDDEN_LAYERS: data.hidden_layers,
    },
    make({ gl }) {
      const weights = makeTable(gl, ["RGBA16F", "RGBA", "HALF_FLOAT"], 4, data.arrays.weights, 256);
      return { uniforms: () => ({ weights, depthBias: data.depth_bias }) };
    },
  };
}

async function allMethods(networks) {
  const maps = [false, true].flatMap((filtered) => MAP_SIZES.map((size) => mapMethod(size, filtered)));
  const found = await Promise.all(networks.map(async (data) => {
    const names = Object.keys(data.arrays);
    const arrays = await Promise.all(names.map((name) => unpack(data.arrays[name])));
    const unpacked = { ...data, arrays: Object.fromEntries(names.map((name, i) => [name, arrays[i]])) };
    return data.encoding === "occupancy_field" ? fieldMethod(unpacked) : networkMethod(unpacked);
  }));
  return [...found, ...maps, noShadow, reference];
}

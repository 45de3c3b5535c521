// What can answer which points are lit. Each method has a key, a name, its shader's files (`sources`)
// and constants, what it keeps in bytes, and `make`, which gives its uniforms for a light; maps are
// drawn anew when it moves. `rays`: it takes a ray to any place of the sun's disc, so its answers to
// many are added up. `soft`: the method in its place under a sun that has a size. `underSun`: how it
// sees such a sun, in words.

const MAP_SIZES = [64, 128, 256, 512, 1024, 2048, 4096];

const MAPS = [
  { kind: "map", name: "", source: "map", underSun: "one test a pixel: hard under any sun" },
  { kind: "pcf", name: ", 2 × 2 PCF", source: "map", filtered: true,
    underSun: "a filter of 2 × 2 texels, whatever the sun's size" },
  { kind: "pcss", name: ", PCSS", source: "pcss",
    underSun: "PCSS: 16 texels for the blockers' height, 32 for the filter" },
];

function mapMethod({ kind, name, source, underSun, filtered = false }, size) {
  return {
    key: `${kind}_${size}`, name: `Shadow map ${size}²${name}`, underSun,
    sources: ["map_heights", source], resident: 4 * size * size,
    make: (renderer) => (light) => ({ ...renderer.mapOf(light, size), filtered }),
  };
}

const noShadow = {
  key: "no_shadow", name: "No shadow", sources: ["no_shadow"], resident: 0,
  make: () => () => ({}),
};

const reference = {
  key: "reference", name: "Ray traced (reference)", sources: ["sun_rays", "ray"], rays: true,
  ofMesh: true, // made anew for another mesh
  make(renderer) {
    const { gl } = renderer, { nodes, triangles } = buildTree(renderer.positions);
    const format = ["RGBA32F", "RGBA", "FLOAT"];
    const values = {
      nodes: makeTable(gl, format, 4, nodes), triangles: makeTable(gl, format, 4, triangles),
      nodeCount: nodes.length / 8,
    };
    return () => values;
  },
};

function networkMethod(data) {
  return {
    ...data, sources: ["sun_rays", "unit_sphere", "network"], rays: true, ofShipped: true,
    constants: {
      FREQUENCIES: data.frequencies, WIDTH: data.width / 4, HIDDEN_LAYERS: data.hidden_layers,
    },
    make({ gl }) {
      const weights = makeTable(gl, ["RGBA16F", "RGBA", "HALF_FLOAT"], 4, data.arrays.weights, 256);
      return () => ({ weights, depthBias: data.depth_bias });
    },
  };
}

async function allMethods(networks) {
  const maps = MAPS.flatMap((kind) => MAP_SIZES.map((size) => mapMethod(kind, size)));
  const found = await Promise.all(networks.map(async (data) => {
    const names = Object.keys(data.arrays);
    const arrays = await Promise.all(names.map((name) => unpack(data.arrays[name])));
    const unpacked = { ...data, arrays: Object.fromEntries(names.map((name, i) => [name, arrays[i]])) };
    return data.encoding === "occupancy_field" ? fieldMethod(unpacked) : networkMethod(unpacked);
  }));
  return [...found, ...maps, noShadow, reference];
}

// What answers how much of the light each pixel sees. `answer` is a generator: it yields between
// passes, so that a drag can stop it, and gives a texture and the channel of the visibility.

const MOMENTS = { taps: 9, biasScale: 0.1, bleeding: 0.1 };
const RAY_COUNTS = [1, 2, 4, 8];

const KIB = (bytes) => bytes < 1 << 20 ? `${Math.round(bytes / 1024)} KiB` : `${(bytes / (1 << 20)).toFixed(1)} MiB`;

// A method by one pass over the light's map. uniforms: of its shader, by the state.
function mapMethod(key, name, sources, uniforms = () => ({})) {
  return {
    key, name, usesMap: true,
    *answer(renderer, state) {
      const target = renderer.target(key, [BITS], ...state.size);
      const made = { ...renderer.surfaces(state), ...renderer.lightMap(state) };
      yield;
      renderer.fill(sources(state), target, { ...made, ...uniforms(state) });
      yield;
      return { texture: target.textures[0], channel: 0 };
    },
  };
}

function bufferMethod(key, name, buffer, channel) {
  return {
    key, name, usesMap: true,
    *answer(renderer, state) {
      const { [buffer]: texture } = renderer.buffers(state);
      yield;
      return { texture, channel };
    },
  };
}

const BOX = ["light_map", "receiver", "box_frag"], SEARCH = ["light_map", "numbers", "discs", "receiver", "blockers_frag"];
const ofPoint = ({ light: { radius } }) => radius === 0;
const MAP_METHODS = [
  bufferMethod("hard", "Shadow map", "visibilities", 2),
  mapMethod("pcf", "PCF, 9 × 9 texels", () => BOX, () => ({ taps: 9 })),
  mapMethod("pcss", "PCSS", (state) => ofPoint(state) ? BOX : SEARCH,
    (state) => ofPoint(state) ? { taps: 1 } : { radius: state.light.radius }),
  bufferMethod("msm_3", "Moments, 3 × 3", "visibilities", 3),
  mapMethod("msm_9", "Moments, 9 × 9", () => ["light_map", "moments", "receiver", "moments_frag"], () => MOMENTS),
];

function rayMethod(count) {
  return {
    key: `rays_${count}`, name: count === 1 ? "1 ray" : `${count} rays`,
    *answer(renderer, state) {
      return { texture: yield* renderer.rays(`rays_${count}`, state, count, { set: true }), channel: 0 };
    },
  };
}

function filteredMethod(count) {
  return {
    key: `rays_${count}_ffx`, name: `${count === 1 ? "1 ray" : `${count} rays`}, filtered`,
    *answer(renderer, state) {
      const rays = yield* renderer.rays(`even_rays_${count}`, state, count, { even: true, set: true }), { size, view } = state;
      const [row, means, even, odd] = ["row", "means", "even", "odd"].map(
        (name) => renderer.target(`ffx_${count}_${name}`, [BITS], ...size));
      renderer.fill(["means_frag"], row, { picture: rays, way: [1, 0] });
      renderer.fill(["means_frag"], means, { picture: row.textures[0], way: [0, 1] });
      yield;
      const { points, normals } = renderer.surfaces(state), [, , forward] = cameraAxes(view);
      let picture = rays;
      for (const [k, step] of [1, 2, 4].entries()) {
        const target = k % 2 ? odd : even;
        renderer.fill(["smooth_frag"], target, {
          picture, means: means.textures[0], points, normals, eye: view.eye, forward, step_: step, begins: k === 0,
        });
        [picture] = target.textures;
        yield;
      }
      return { texture: picture, channel: 0 };
    },
  };
}

// Rays without end: each call sends up to `state.truth` of a pixel.
const truth = {
  key: "truth", name: "Ray traced (reference)",
  *answer(renderer, state) {
    return { texture: yield* renderer.rays("truth", state, state.truth), channel: 0 };
  },
};

function conesMethod(fields) {
  return {
    key: "cones", name: "Cones, distance fields", storedAs: "fields", stored: fields.reduce((sum, { stored }) => sum + stored, 0),
    *answer(renderer, state) {
      return { texture: yield* renderer.cones(state), channel: 0 };
    },
  };
}

// A trained network of the page. data: see viewer/write_soft_viewer.py.
function networkMethod(data) {
  let network = null, planes = null;
  const usesMap = data.features.some((name) => MAP_FEATURES.includes(name));
  return {
    key: data.key, name: data.name, stored: data.stored, storedAs: "weights", reach: data.largest, usesMap,
    // Its input planes, rows from the top, for tests: (planes, height · width).
    planes: (renderer, size) => Array.from({ length: data.planes }, (_, k) => {
      const { gl } = renderer, layer = makeLayerFramebuffer(gl, network.planes, k >> 2, 1);
      const numbers = readFloats(gl, ...size);
      gl.deleteFramebuffer(layer);
      return Array.from({ length: numbers.length / 4 }, (__, i) => numbers[4 * i + k % 4]);
    }),
    *answer(renderer, state) {
      const { size, view, light } = state;
      if (network?.width !== size[0] || network?.height !== size[1]) {
        network?.free();
        network = new ScreenNetwork(renderer.gl, renderer.shaders, data, ...size);
        planes = makeLayerFramebuffer(renderer.gl, network.planes, 0, Math.ceil(data.planes / 4));
        yield;
      }
      const traced = data.rays ? yield* renderer.rays("base_rays", state, data.rays, { penumbrae: true, even: true, set: true }) : null;
      const made = usesMap ? renderer.buffers(state) : {};
      yield;
      const [, , forward] = cameraAxes(view), { points, normals } = renderer.surfaces(state);
      renderer.fill([featureShader(data.features)], { framebuffer: planes, width: size[0], height: size[1] }, {
        points, normals, ...made, ...(traced && { traced }), eye: view.eye, forward, centre: light.centre,
        sceneSize: renderer.scene.size, share: light.radius / renderer.scene.size, lightStep: 4 * light.radius / data.largest,
        focal: size[1] / 2 / Math.tan(view.fov * Math.PI / 360),
      });
      yield;
      return { texture: yield* network.run(), channel: 0 };
    },
  };
}

function allMethods(networks, fields) {
  return [
    truth, ...networks.map(networkMethod), ...RAY_COUNTS.map(rayMethod), ...RAY_COUNTS.map(filteredMethod),
    ...(fields.length ? [conesMethod(fields)] : []), ...MAP_METHODS,
  ];
}

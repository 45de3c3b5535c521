// Passes on the graphics processor: surface points, the light's map, buffers and rays. Results are kept as
// long as what they depend on stays. A `state` has `view` (eye, target, up, fov), `light` (centre, radius),
// `move` (see motionOf), and `size` (width, height) of the picture.

const BYTES = ["RGBA8", "RGBA", "UNSIGNED_BYTE"];
const MOST_TAPS = 9; // of a filter of moments, along an axis
const CONSTANTS = {
  ROW_BRICKS, SOLID, MOST_TAPS, SEARCHED: 64, FILTERED: 128,
  SPREAD: "0.01", // of depths round a receiver: about 1 in moments' units
  GAUSSIAN_SIDE: (Math.exp(-0.5 / 0.55 ** 2) / (1 + 2 * Math.exp(-0.5 / 0.55 ** 2))).toFixed(9),
};
const RANGE = [0.005, 200]; // metres, of the light's map
const EMPTY = 1e30;

class Renderer {
  constructor(canvas, shaders, scene) {
    const gl = this.gl = openWebgl(canvas);
    Object.assign(this, { canvas, shaders, scene, programs: {}, targets: {}, kept: {} });
    gl.disable(gl.DITHER);
    this.finish = makeFinish(gl);
    this.screen = gl.createVertexArray();
    this.surface = makeProgram(gl, shaders.surface_vert, shaders.floats + shaders.surface_frag);
    this.depths = makeProgram(gl, shaders.depths_vert, shaders.floats + shaders.depths_frag);
    this.parts = [scene.staying, scene.moving].map((part) => {
      const { position, faceNormal } = part;
      return { seen: makeVertices(gl, this.surface, part), casting: makeVertices(gl, this.depths, { position, faceNormal }) };
    });
    this.constants = { ...CONSTANTS, SAMPLES_PER_CELL: `${scene.samplesPerCell}.0` };
    this.trees = {};
    this.fields = scene.fields.map(() => null); // textures, made when a cone first needs them
  }

  target(name, formats, width, height, deep = false) {
    const { [name]: known } = this.targets;
    if (known && known.width === width && known.height === height) return known;
    known?.free();
    delete this.kept[name];
    this.targets[name] = makeTarget(this.gl, formats, width, height, deep);
    return this.targets[name];
  }

  // The target of a name, drawn anew if what it shows has changed.
  keep(name, dependsOn, formats, [width, height], draw, deep = false) {
    const target = this.target(name, formats, width, height, deep), key = JSON.stringify(dependsOn);
    if (this.kept[name] !== key) draw(target);
    this.kept[name] = key;
    return target.textures;
  }

  // Draws a program's fragment over a whole target. sources: names of shaders, joined.
  fill(sources, target, uniforms) {
    const { gl, shaders } = this, name = sources.join("+");
    this.programs[name] ??= makeProgram(
      gl, shaders.screen_vert, ["floats", ...sources].map((source) => shaders[source] ?? source).join("\n"), this.constants);
    gl.bindFramebuffer(gl.FRAMEBUFFER, target?.framebuffer ?? null);
    gl.viewport(0, 0, target?.width ?? this.canvas.width, target?.height ?? this.canvas.height);
    setUniforms(gl, this.programs[name], uniforms);
    gl.bindVertexArray(this.screen);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }

  motion(state) {
    return motionOf(this.scene.rest, state.move);
  }

  surfaces(state, name = "surfaces") {
    const { gl } = this, { view, size, move } = state;
    const textures = this.keep(name, [view, move, size], [BITS, BITS, BITS, BYTES], size, (target) => {
      gl.bindFramebuffer(gl.FRAMEBUFFER, target.framebuffer);
      gl.viewport(0, 0, ...size);
      for (let i = 0; i < 3; i++) gl.clearBufferuiv(gl.COLOR, i, [0, 0, 0, 0]);
      gl.clearBufferfv(gl.COLOR, 3, [0, 0, 0, 0]);
      gl.clearBufferfv(gl.DEPTH, 0, [1]);
      this.#drawParts(this.surface, "seen", state, {
        camera: cameraMatrix(view, size[0] / size[1]), pixels: pixelMatrix(view, ...size), height: size[1], eye: view.eye,
      });
    }, true);
    const [points, normals, faces, colours] = textures;
    return { points, normals, faces, colours };
  }

  #drawParts(program, kind, state, uniforms) {
    const { gl } = this;
    gl.enable(gl.DEPTH_TEST);
    this.parts.forEach((part, i) => {
      setUniforms(gl, program, { ...uniforms, motion: i ? this.motion(state).forwards : IDENTITY });
      gl.bindVertexArray(part[kind].vertices);
      gl.drawArrays(gl.TRIANGLES, 0, part[kind].count);
    });
    gl.disable(gl.DEPTH_TEST);
  }

  // Distances from the light's centre in all directions, with the uniforms that look them up.
  lightMap(state) {
    const { gl } = this, { light: { centre }, move, resolution } = state, size = [3 * resolution, 2 * resolution];
    const [depths] = this.keep("map", [centre, move, resolution], [ONE_FLOATS_BITS], size, (target) => {
      gl.bindFramebuffer(gl.FRAMEBUFFER, target.framebuffer);
      clearFloat(gl, EMPTY);
      gl.clearBufferfv(gl.DEPTH, 0, [1]);
      gl.enable(gl.SCISSOR_TEST);
      for (let face = 0; face < 6; face++) {
        const place = [resolution * (face % 3), resolution * Math.floor(face / 3), resolution, resolution];
        gl.viewport(...place);
        gl.scissor(...place);
        this.#drawParts(this.depths, "casting", state, {
          centre, axes: faceAxes(face), range: RANGE, begin: place.slice(0, 2), side: resolution,
        });
      }
      gl.disable(gl.SCISSOR_TEST);
    }, true);
    return { depths, resolution, centre, sceneSize: this.scene.size };
  }

  buffers(state) {
    const { view, light: { centre }, move, size, resolution } = state;
    const [lengths, visibilities, pcf] = this.keep(
      "buffers", [view, centre, move, size, resolution], [BITS, BITS, BITS], size, (target) => {
        const sources = ["light_map", "moments", "receiver", "buffers_frag"];
        this.fill(sources, target, { ...this.surfaces(state), ...this.lightMap(state), eye: view.eye });
      });
    return { lengths, visibilities, pcf };
  }

  // Uniforms of rays through the scene, or only what is open there. Trees are made when a ray first needs them.
  rayUniforms(state, open) {
    const { staying: { position: still }, moving: { position: mobile }, openStaying, openMoving } = this.scene;
    this.trees[open] ??= (open ? [openStaying, openMoving] : [still, mobile]).map((positions) => {
      const { nodes, triangles } = buildTree(positions), table = (data) => makeTable(this.gl, FLOATS, 4, data);
      return { nodes: table(nodes), triangles: table(triangles), count: positions.length ? nodes.length / 8 : 0 };
    });
    const [staying, moving] = this.trees[open];
    return {
      stayingNodes: staying.nodes, stayingTriangles: staying.triangles, stayingCount: staying.count,
      movingNodes: moving.nodes, movingTriangles: moving.triangles, movingCount: moving.count,
      backwards: this.motion(state).backwards,
    };
  }

  // Sends rays until a pixel has `count`, some at a time; goes on where an earlier call of this name
  // stopped. Gives the texture of rays.frag. `set`: all `count` make up one set, not the begin of a sequence.
  *rays(name, state, count, { penumbrae = false, open = false, even = false, set = false } = {}) {
    const { view, light: { centre, radius }, move, size } = state;
    const goal = radius > 0 ? count : 1; // to a point all rays are the same
    const whole = set && goal >= (even ? 2 : 3) ? goal : 0; // a spiral, where frames/ray_tracing.py has one
    const key = JSON.stringify([view, centre, radius, move, size, penumbrae, even]);
    const pair = [0, 1].map((k) => this.target(`${name}_${k}`, [BITS], ...size));
    let sent = this.kept[`${name}_1`] === undefined ? undefined : this.kept[name];
    if (sent?.key !== key || sent.count > goal) sent = { key, count: 0, side: 0 };
    while (sent.count < goal) {
      const more = Math.min(RAYS_AT_ONCE, goal - sent.count), [target, other] = [pair[1 - sent.side], pair[sent.side]];
      this.fill(["receiver", "numbers", "discs", "trees", "rays_frag"], target, {
        ...this.surfaces(state), ...this.rayUniforms(state, open), before: other.textures[0], centre, radius,
        sceneSize: this.scene.size, first: sent.count, count: more, whole, penumbrae, even,
      });
      sent = { key, count: sent.count + more, side: 1 - sent.side };
      this.kept[name] = sent;
      this.kept[`${name}_1`] = key;
      yield;
    }
    return pair[sent.side].textures[0];
  }

  // Cones past one field after the other, and rays past open objects. Gives a texture.
  *cones(state) {
    const { gl, scene } = this, { light: { centre, radius }, size } = state, { backwards } = this.motion(state);
    const pair = ["cones_even", "cones_odd"].map((name) => this.target(name, [BITS], ...size));
    // A point's ray starts a cell off: fields are not quite where triangles are.
    const past = radius > 0 ? { sources: ["cones"], values: { lift: 1e-4 * scene.size } } : {
      sources: ["unit_sphere", "field", "field_ray"], values: { lift: scene.cell, level: 0, depthBias: 0, sheet: false },
    };
    const isOpen = scene.openStaying.length + scene.openMoving.length > 0;
    let before = isOpen ? yield* this.rays("open_rays", state, OPEN_RAYS, { open: true }) : null;
    for (const [k, field] of scene.fields.entries()) {
      this.fields[k] ??= { ...fieldTextures(gl, field), ...coneUniforms(gl, field) };
      const target = pair[k % 2], known = before ?? pair[1].textures[0];
      this.fill(["discs", "receiver", "field_values", ...past.sources, "past_field_frag"], target, {
        ...this.surfaces(state), ...this.fields[k], before: known, begins: before === null, centre, radius,
        sceneSize: scene.size, ...past.values, backwards: field.moves ? backwards : IDENTITY, middle: field.centre, reach: field.radius,
      });
      [before] = target.textures;
      yield;
    }
    return before;
  }

  // A texture's numbers, rows from the top: (height · width, 4) float32.
  read(texture, size) {
    const { gl } = this, framebuffer = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture.texture, 0);
    const numbers = readFloats(gl, ...size);
    gl.deleteFramebuffer(framebuffer);
    return numbers;
  }
}

const OPEN_RAYS = 8; // of a pixel, past objects without a field (evaluation/methods/object_cones.py)
const RAYS_AT_ONCE = 2; // of a pixel: a drag interrupts between two passes
const IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

// Columns right, down and forward of a cube map's face (shadow_maps/light_map.py).
function faceAxes(face) {
  const axis = Math.floor(face / 2), sign = face % 2 ? -1 : 1, along = (k, x) => [0, 1, 2].map((i) => i === k % 3 ? x : 0);
  return [...along(axis + 1, 1), ...along(axis + 2, sign), ...along(axis, sign)];
}

// Passes: surface points of a camera; each method's answer at them; the picture.

const FLOATS = ["RGBA32F", "RGBA", "FLOAT"], BYTES = ["RGBA8", "RGBA", "UNSIGNED_BYTE"];

class Renderer {
  // mesh: of `unpackMesh`; ground: its height along `up`, or null.
  constructor(canvas, shaders, constants, mesh, { up, ground, ground_radius: groundRadius }) {
    const gl = this.gl = openWebgl(canvas);
    Object.assign(this, { canvas, shaders, up, height: ground, vertices: mesh.vertices });
    this.surface = makeProgram(gl, shaders.surface_vert, shaders.surface_frag, constants);
    this.heights = makeProgram(gl, shaders.heights_vert, shaders.heights_frag);
    this.picture = makeProgram(gl, shaders.screen_vert, shaders.picture_frag, constants);
    const { positions, vertexNormals, faceNormals } = corners(mesh);
    this.positions = positions;
    this.object = makeVertices(gl, this.surface, {
      position: positions, normal: vertexNormals, faceNormal: faceNormals,
    });
    this.occluder = makeVertices(gl, this.heights, { position: positions });
    this.rim = ground === null ? 0 : groundRadius ** 2 + ground ** 2;
    this.ground = ground === null ? null : makeVertices(gl, this.surface, groundQuad(up, ground, groundRadius));
    this.screen = gl.createVertexArray();
    this.made = new Map(); // by method's key: its program and what it told
    this.maps = new Map(); // by size: a shadow map and the light it is of
    this.targets = {};
    this.seen = "";
  }

  #target(name, formats, width, height, deep = false) {
    const { [name]: known } = this.targets;
    if (known && known.width === width && known.height === height) return known;
    known?.free();
    if (name === "points") this.seen = "";
    this.targets[name] = makeTarget(this.gl, formats, width, height, deep);
    return this.targets[name];
  }

  // The surface points that a viewpoint sees, kept while it stands still.
  look(view, width, height) {
    const { gl } = this, points = this.#target("points", [FLOATS, FLOATS, FLOATS], width, height, true);
    const seen = JSON.stringify([view.eye, view.target, view.up, view.fov]);
    if (seen === this.seen) return points.textures;
    this.seen = seen;
    gl.bindFramebuffer(gl.FRAMEBUFFER, points.framebuffer);
    gl.viewport(0, 0, width, height);
    for (let i = 0; i < 3; i++) gl.clearBufferfv(gl.COLOR, i, [0, 0, 0, 0]);
    gl.clearBufferfv(gl.DEPTH, 0, [1]);
    const told = {
      camera: cameraMatrix(view, width / height), pixels: pixelMatrix(view, width, height),
      eye: view.eye, rim: this.rim, drop: (this.height ?? 0) - dot(view.eye, this.up),
    };
    const draw = (mesh, kind) => {
      setUniforms(gl, this.surface, { ...told, kind });
      gl.bindVertexArray(mesh.vertices);
      gl.drawArrays(gl.TRIANGLES, 0, mesh.count);
    };
    // The ground leaves no depth: the object stands on it, and is always before it.
    if (this.ground) draw(this.ground, 2);
    gl.enable(gl.DEPTH_TEST);
    draw(this.object, 1);
    gl.disable(gl.DEPTH_TEST);
    return points.textures;
  }

  // Forget which light the maps are of, so that the next is drawn.
  dropMaps() {
    for (const map of this.maps.values()) map.light = [];
  }

  // A shadow map of a light, as a shader's uniforms (shadow_maps/shadow_map.py). Those of the last
  // two sizes are kept: one of 4096² takes 128 MiB with its depths.
  mapOf(light, size) {
    const known = this.maps.get(size), { gl } = this;
    if (known && light.every((x, i) => x === known.light[i])) return known.uniforms;
    const rows = basisOf(light), low = [Infinity, Infinity, Infinity], high = low.map((x) => -x);
    const { vertices } = this;
    for (let i = 0; i < vertices.length; i += 3) {
      for (let k = 0; k < 3; k++) {
        const [x, y, z] = rows[k], place = x * vertices[i] + y * vertices[i + 1] + z * vertices[i + 2];
        if (place < low[k]) low[k] = place;
        if (place > high[k]) high[k] = place;
      }
    }
    const side = Math.max(high[0] - low[0], high[1] - low[1]);
    const corner = [(low[0] + high[0] - side) / 2, (low[1] + high[1] - side) / 2, low[2]];
    const basis = rows.flat(), target = known?.target ?? makeTarget(gl, [["R32F", "RED", "FLOAT"]], size, size, true);
    gl.bindFramebuffer(gl.FRAMEBUFFER, target.framebuffer);
    gl.viewport(0, 0, size, size);
    gl.clearBufferfv(gl.COLOR, 0, [-1e30, 0, 0, 0]);
    gl.clearBufferfv(gl.DEPTH, 0, [1]);
    gl.enable(gl.DEPTH_TEST);
    setUniforms(gl, this.heights, { basis, corner, side, highest: high[2] });
    gl.bindVertexArray(this.occluder.vertices);
    gl.drawArrays(gl.TRIANGLES, 0, this.occluder.count);
    gl.disable(gl.DEPTH_TEST);
    const uniforms = { heights: target.textures[0], basis, corner, side };
    this.maps.delete(size);
    this.maps.set(size, { light: [...light], target, uniforms });
    const [oldest] = this.maps.keys();
    if (this.maps.size > 2) {
      this.maps.get(oldest).target.free();
      this.maps.delete(oldest);
    }
    return uniforms;
  }

  // A method's program, and what it is told of a light; made when it is first asked for.
  prepare(method) {
    if (!this.made.has(method.key)) {
      const source = this.shaders.visibility_frag + this.shaders[method.source];
      const program = makeProgram(this.gl, this.shaders.screen_vert, source, method.constants);
      this.made.set(method.key, { program, ...method.make(this) });
    }
    return this.made.get(method.key);
  }

  // A method's answers at the points of a viewpoint, between two columns: a texture.
  answer(method, name, view, light, width, height, from = 0, to = width) {
    const { gl } = this;
    const [points, faceNormals] = this.look(view, width, height);
    const { program, uniforms } = this.prepare(method), told = uniforms(light);
    const target = this.#target(name, [BYTES], width, height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, target.framebuffer);
    gl.viewport(0, 0, width, height);
    gl.enable(gl.SCISSOR_TEST);
    gl.scissor(from, 0, Math.max(0, to - from), height);
    setUniforms(gl, program, { points, faceNormals, light, ...told });
    gl.bindVertexArray(this.screen);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.disable(gl.SCISSOR_TEST);
    return target.textures[0];
  }

  // The same read back, rows from the top: (height · width, 4) bytes; see visibility.frag.
  read(name) {
    const { gl } = this, { framebuffer, width, height } = this.targets[name];
    const pixels = new Uint8Array(4 * width * height), row = 4 * width;
    gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    const turned = new Uint8Array(pixels.length);
    for (let y = 0; y < height; y++) turned.set(pixels.subarray(y * row, (y + 1) * row), (height - 1 - y) * row);
    return turned;
  }

  // Waits until all that was asked for is drawn: one pixel can only be read then.
  finish() {
    const { gl } = this;
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
  }

  show({ left, right, reference, light, divider, errors }) {
    const { gl, canvas, targets: { points } } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, canvas.width, canvas.height);
    setUniforms(gl, this.picture, {
      shadingNormals: points.textures[2], left, right, reference, light, divider,
      errors, share: [points.width / canvas.width, points.height / canvas.height],
    });
    gl.bindVertexArray(this.screen);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }
}

// Two triangles that hold the ground's disc.
function groundQuad(up, height, radius) {
  const [u, v] = basisOf(up), middle = up.map((x) => x * height), reach = 2 * radius;
  const at = (a, b) => plus(plus(middle, u, a * reach), v, b * reach);
  const position = [[-1, -1], [1, -1], [1, 1], [-1, -1], [1, 1], [-1, 1]].flatMap(([a, b]) => at(a, b));
  const normal = Float32Array.from({ length: 18 }, (_, i) => up[i % 3]);
  return { position: Float32Array.from(position), normal, faceNormal: normal };
}

// Shares of the points seen that a method calls dark where the reference is lit, and lit where it is
// dark, as metrics/shadow_error.py counts them.
function wrongShares(answers, truth) {
  let dark = 0, lit = 0, seen = 0;
  for (let i = 0; i < answers.length; i += 4) {
    seen += truth[i + 1] > 0;
    const wrong = (answers[i] - truth[i]) / 255;
    if (wrong < 0) dark -= wrong;
    else lit += wrong;
  }
  return { falseShadow: dark / Math.max(1, seen), lightLeak: lit / Math.max(1, seen) };
}

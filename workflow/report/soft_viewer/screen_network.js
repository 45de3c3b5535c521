// Screen-space networks (viewer/screen_arrays.py): one draw a layer.

const networkPrograms = new WeakMap(); // by context, then shader and constants: of frames of any size

class ScreenNetwork {
  // data: of screen_arrays.py, with its weights unpacked. float: maps in float32, in two draws each, for
  // tests. The caller draws the planes: number k into component k & 3 of layer k >> 2. A frame's upper
  // row is texel row 0.
  constructor(gl, shaders, data, width, height, { float = false } = {}) {
    const deepest = Math.max(...data.plan.map(({ level }) => level));
    const across = 4 << deepest, down = 2 << deepest; // whole blocks of the deepest level
    if (width % across || height % down) {
      throw new Error(`${width} × ${height}: no size for this network. Use multiples of ${across} × ${down}.`);
    }
    Object.assign(this, { gl, shaders, data, width, height, float, layers: [], targets: [], made: [], lost: false });
    // No call fails on a lost context: its pictures are black.
    this.onLost = () => { this.lost = true; };
    gl.canvas.addEventListener("webglcontextlost", this.onLost);
    this.planes = this.#texture(BITS, [width, height, Math.ceil(data.planes / 4)]);
    this.weights = new Uint32Array(data.arrays.weights.buffer);
    for (const step of data.plan) this.targets.push(this.#target(step));
  }

  // Draws a layer a step, so that a caller can spread them over frames; with blending and tests of depth
  // and scissors off. Returns a texture: visibility in r, not cut off at 0 and 1.
  *run() {
    const { gl } = this;
    for (const { program, target, uniforms } of this.layers) {
      this.#checkContext();
      program.finished ??= finishProgram(gl, program.begun);
      gl.bindFramebuffer(gl.FRAMEBUFFER, target.framebuffer);
      gl.viewport(0, 0, target.width, target.height);
      setUniforms(gl, program.finished, uniforms);
      gl.bindVertexArray(null);
      gl.drawArrays(gl.TRIANGLES, 0, 3);
      yield;
    }
    this.#checkContext();
    return this.targets.at(-1).textures[0];
  }

  free() {
    this.gl.canvas.removeEventListener("webglcontextlost", this.onLost);
    this.made.forEach((free) => free());
  }

  #checkContext() {
    if (this.lost || this.gl.isContextLost()) {
      throw new Unavailable("The browser has dropped this page's graphics. Load the page again.");
    }
  }

  #target(step) {
    const { planes, width, height } = this, source = this.targets.at(-1), mode = { [step.mode]: 1 };
    const whole = [width, height], halved = [width / 2, height / 2]; // squares of 2 × 2 pixels
    const { base, guide, edge } = this.data, edged = edge === null ? {} : { EDGE: 1 };
    switch (step.kind) {
      case "entrance": return this.#map("network_entrance", mode, step, { planes, ranges: this.#ranges() });
      case "convolution": return this.#convolution(step, source);
      case "pool": return this.#map("network_pool", mode, step, {}, source);
      case "enlargement": return this.#map("network_enlargement", {}, step, {}, source);
      case "exit": return this.#picture("network_exit", mode, whole, {}, source);
      case "base":
        return this.#picture("kernel_entrance", edged, halved, { planes, base, guide }, null, edge === null ? 1 : 2);
      case "filter": {
        const { texture: logits, tile } = this.targets[step.logits], [, guides] = this.targets[step.guides].textures;
        const { dilation, first } = step, adjacent = dilation === 1 ? { ADJACENT: 1 } : {};
        const uniforms = { logits, tile, first, dilation, guides, edge };
        return this.#picture("kernel_filter", { ...adjacent, ...edged }, halved, uniforms, source);
      }
      case "filtered": return this.#picture("kernel_exit", {}, whole, {}, source);
    }
  }

  // Centres and spreads of the planes, four a texel.
  #ranges() {
    const { centres, spreads } = this.data, texels = Math.ceil(centres.length / 4);
    const ranges = new Float32Array(8 * texels).fill(1); // 1 for planes that are not used
    ranges.set(centres);
    ranges.set(spreads, 4 * texels);
    return this.#texture(FLOATS, [texels, 2], ranges);
  }

  #convolution(step, source) {
    const columns = 2 * step.size ** 2 + 1, inputs = Math.ceil(step.inputs / 4);
    const rows = inputs * Math.ceil(step.channels / 4), count = 4 * columns * rows;
    const weights = this.#texture(BITS, [columns, rows], this.weights.subarray(0, count));
    this.weights = this.weights.subarray(count);
    const constants = { SIZE: step.size, [step.border]: 1, ...(step.relu && { RELU: 1 }) };
    return this.#map("network_convolution", constants, step, { weights, inputs }, source);
  }

  // A layer that draws a map, see network_maps.glsl.
  #map(shader, constants, { level, channels, skip }, uniforms, source) {
    const { gl, float, width, height } = this, tile = [width >> level + 2, height >> level + 1];
    const parts = float ? [0, 1] : [0], size = [tile[0] * Math.ceil(channels / 4), tile[1], 4 * parts.length];
    const texture = this.#texture(BITS, size);
    const skipped = skip === undefined ? {} : { SKIP: 1 };
    const maps = { tile, source: source?.texture, sourceTile: source?.tile, skip: this.targets[skip]?.texture };
    for (const part of parts) {
      const framebuffer = makeLayerFramebuffer(gl, texture, 4 * part, 4);
      this.made.push(() => gl.deleteFramebuffer(framebuffer));
      const target = { framebuffer, width: size[0], height: size[1] };
      this.#addLayer(shader, { ...constants, ...skipped }, target, { ...maps, ...uniforms, part });
    }
    return { texture, tile };
  }

  // A layer that draws float32 of pixels, or of squares of them.
  #picture(shader, constants, size, uniforms, source, count = 1) {
    const target = makeTarget(this.gl, Array(count).fill(BITS), ...size);
    this.made.push(target.free);
    const maps = { source: source?.texture ?? source?.textures[0], sourceTile: source?.tile };
    this.#addLayer(shader, constants, target, { ...maps, ...uniforms });
    return target;
  }

  #addLayer(shader, constants, target, uniforms) {
    const program = this.#program(shader, { [this.float ? "FLOATS" : "HALVES"]: 1, ...constants });
    this.layers.push({ program, target, uniforms });
  }

  #program(shader, constants) {
    const { gl, shaders } = this;
    if (!networkPrograms.has(gl)) networkPrograms.set(gl, new Map());
    const known = networkPrograms.get(gl), key = shader + JSON.stringify(constants);
    if (!known.has(key)) {
      const source = unrolled(shaders.floats + shaders.network_maps + shaders[`${shader}_frag`]);
      known.set(key, { begun: beginProgram(gl, shaders.screen_vert, source, constants) });
    }
    return known.get(key);
  }

  #texture(format, size, data) {
    const { gl } = this, kind = size.length === 3 ? gl.TEXTURE_2D_ARRAY : gl.TEXTURE_2D;
    const texture = makeTexture(gl, format, size, data, kind);
    this.made.push(() => gl.deleteTexture(texture.texture));
    return texture;
  }
}

// A shader with the lines from `#unroll k 8` to `#end` for each k below 8. Arrays that only constants index
// stay in registers: with loops SwiftShader takes 2.7 times as long for a network.
function unrolled(source) {
  const innermost = /^#unroll (\w+) (\d+)\n((?:(?!#unroll).*\n)*?)#end\n/m;
  for (let loop = innermost.exec(source); loop; loop = innermost.exec(source)) {
    const [lines, name, count, body] = loop, word = new RegExp(`\\b${name}\\b`, "g");
    const copies = Array.from({ length: count }, (_, number) => body.replace(word, number));
    source = source.replace(lines, () => copies.join(""));
  }
  return source;
}

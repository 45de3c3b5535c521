// WebGL2 in a few words: programs, textures, targets, and drawing with named uniforms.

class Unavailable extends Error {}

// Formats of textures: [internal, format, type]. Any WebGL2 draws bits; floats, an extension.
const FLOATS = ["RGBA32F", "RGBA", "FLOAT"], BITS = ["RGBA32UI", "RGBA_INTEGER", "UNSIGNED_INT"];
const ONE_FLOATS_BITS = ["R32UI", "RED_INTEGER", "UNSIGNED_INT"];

function openWebgl(canvas) {
  // Kept, so that a band of it can be drawn anew and the rest stays.
  const gl = canvas.getContext("webgl2", { antialias: false, alpha: false, preserveDrawingBuffer: true });
  if (!gl) throw new Unavailable("This browser has no WebGL2, or it is switched off.");
  return gl;
}

// Begins to compile and link; drivers do several at a time until one is finished.
function beginProgram(gl, vertex, fragment, constants = {}) {
  const defines = Object.entries(constants).map(([name, value]) => `#define ${name} ${value}\n`);
  // Without the latter phones may read positions and heights as half floats.
  const exact = [
    "float", "int", "sampler2D", "isampler2D", "sampler3D", "isampler3D", "usampler2D", "sampler2DArray", "usampler2DArray",
  ];
  const precisions = exact.map((type) => `precision highp ${type};\n`);
  const head = ["#version 300 es\n", ...precisions, ...defines].join("");
  const program = gl.createProgram();
  for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, head + source);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  return program;
}

function finishProgram(gl, program) {
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) {
    const logs = gl.getAttachedShaders(program).map((shader) => gl.getShaderInfoLog(shader));
    throw new Error([...logs, gl.getProgramInfoLog(program)].join("") || "a shader does not compile");
  }
  const uniforms = {};
  for (let i = 0; i < gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); i++) {
    const { name, type } = gl.getActiveUniform(program, i);
    uniforms[name] = { type, place: gl.getUniformLocation(program, name) };
  }
  return { program, uniforms };
}

function makeProgram(gl, vertex, fragment, constants) {
  return finishProgram(gl, beginProgram(gl, vertex, fragment, constants));
}

// data: null for a target. Texels are fetched, never filtered.
function makeTexture(gl, format, [width, height, depth], data = null, kind = depth ? gl.TEXTURE_3D : gl.TEXTURE_2D) {
  const texture = gl.createTexture();
  const most = gl.getParameter(kind === gl.TEXTURE_3D ? gl.MAX_3D_TEXTURE_SIZE : gl.MAX_TEXTURE_SIZE);
  if (Math.max(width, height, depth ?? 0) > most) {
    throw new Unavailable(`This device's textures end at ${most} texels, too few for this method.`);
  }
  gl.bindTexture(kind, texture);
  gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
  const [internal, ...rest] = format.map((name) => gl[name]);
  if (depth) gl.texImage3D(kind, 0, internal, width, height, depth, 0, ...rest, data);
  else gl.texImage2D(kind, 0, internal, width, height, 0, ...rest, data);
  for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) {
    gl.texParameteri(kind, filter, gl.NEAREST);
  }
  return { texture, kind };
}

// Numbers as rows of a texture of `channels` each: what is left of the last row stays zero.
function makeTable(gl, format, channels, data, width = 1024) {
  const height = Math.max(1, Math.ceil(data.length / channels / width));
  const whole = new data.constructor(width * height * channels);
  whole.set(data);
  return makeTexture(gl, format, [width, height], whole);
}

// Textures to draw into, and a depth buffer if `deep`.
function makeTarget(gl, formats, width, height, deep = false) {
  const textures = formats.map((format) => makeTexture(gl, format, [width, height]));
  const framebuffer = gl.createFramebuffer();
  gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
  textures.forEach(({ texture }, i) => gl.framebufferTexture2D(
    gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0 + i, gl.TEXTURE_2D, texture, 0));
  gl.drawBuffers(textures.map((_, i) => gl.COLOR_ATTACHMENT0 + i));
  const depth = deep ? gl.createRenderbuffer() : null;
  if (deep) {
    gl.bindRenderbuffer(gl.RENDERBUFFER, depth);
    gl.renderbufferStorage(gl.RENDERBUFFER, gl.DEPTH_COMPONENT32F, width, height);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER, depth);
  }
  const free = () => {
    textures.forEach(({ texture }) => gl.deleteTexture(texture));
    gl.deleteFramebuffer(framebuffer);
    gl.deleteRenderbuffer(depth);
  };
  return { framebuffer, textures, width, height, free };
}

// A framebuffer of an array texture's layers.
function makeLayerFramebuffer(gl, { texture }, first, count) {
  const framebuffer = gl.createFramebuffer();
  gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
  const places = Array.from({ length: count }, (_, i) => gl.COLOR_ATTACHMENT0 + i);
  places.forEach((place, i) => gl.framebufferTextureLayer(gl.FRAMEBUFFER, place, texture, 0, first + i));
  gl.drawBuffers(places);
  return framebuffer;
}

// A function that waits until all that was drawn before it is there. It reads a target of its own:
// of another it depends on the format what may be read.
function makeFinish(gl) {
  const { framebuffer } = makeTarget(gl, [["RGBA8", "RGBA", "UNSIGNED_BYTE"]], 1, 1);
  const pixel = new Uint8Array(4);
  return () => {
    gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
  };
}

// The bound framebuffer's floats, drawn as bits: four a pixel.
function readFloats(gl, width, height) {
  const bits = new Uint32Array(4 * width * height);
  gl.readPixels(0, 0, width, height, gl.RGBA_INTEGER, gl.UNSIGNED_INT, bits);
  return new Float32Array(bits.buffer);
}

// Fills the first of the bound framebuffer's textures with a float's bits.
function clearFloat(gl, value) {
  gl.clearBufferuiv(gl.COLOR, 0, new Uint32Array(Float32Array.of(value, 0, 0, 0).buffer));
}

function setUniforms(gl, { program, uniforms }, values) {
  gl.useProgram(program);
  let unit = 0;
  for (const [name, { type, place }] of Object.entries(uniforms)) {
    const value = values[name];
    if (value === undefined) throw new Error(`uniform ${name} has no value`);
    if (value.texture) {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(value.kind, value.texture);
      gl.uniform1i(place, unit++);
    } else if (type === gl.FLOAT) gl.uniform1f(place, value);
    else if (type === gl.FLOAT_VEC2) gl.uniform2fv(place, value);
    else if (type === gl.FLOAT_VEC3) gl.uniform3fv(place, value);
    else if (type === gl.FLOAT_VEC4) gl.uniform4fv(place, value);
    else if (type === gl.INT_VEC2) gl.uniform2iv(place, value);
    else if (type === gl.FLOAT_MAT3) gl.uniformMatrix3fv(place, false, value);
    else if (type === gl.FLOAT_MAT4) gl.uniformMatrix4fv(place, false, value);
    else gl.uniform1i(place, Number(value)); // int or bool
  }
}

// arrays: by attribute, three numbers a vertex.
function makeVertices(gl, program, arrays) {
  const vertices = gl.createVertexArray();
  gl.bindVertexArray(vertices);
  for (const [name, array] of Object.entries(arrays)) {
    const place = gl.getAttribLocation(program.program, name);
    if (place < 0) continue;
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, array, gl.STATIC_DRAW);
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, 3, gl.FLOAT, false, 0, 0);
  }
  return { vertices, count: Object.values(arrays)[0].length / 3 };
}

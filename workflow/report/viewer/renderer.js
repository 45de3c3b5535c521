// Passes: surface points of a camera; each method's answer at them; the picture.

const SUMS = ["RG16F", "RG", "HALF_FLOAT"]; // exact up to 2,048 rays; bits cannot be added by blending
const NORMALS = ["RGBA16F", "RGBA", "HALF_FLOAT"]; // for shading

class Renderer {
  // up, groundRadius: of the scene.
  constructor(canvas, shaders, constants, { up, ground_radius: groundRadius }) {
    const gl = this.gl = openWebgl(canvas);
    if (!gl.getExtension("EXT_color_buffer_float") && !gl.getExtension("EXT_color_buffer_half_float")) {
      throw new Unavailable("This browser's WebGL2 cannot draw floating-point numbers.");
    }
    Object.assign(this, { canvas, shaders, up, groundRadius });
    this.surface = makeProgram(gl, shaders.surface_vert, shaders.floats + shaders.surface_frag, constants);
    this.heights = makeProgram(gl, shaders.heights_vert, shaders.floats + shaders.heights_frag);
    this.picture = makeProgram(gl, shaders.screen_vert, shaders.picture_frag, constants);
    this.screen = gl.createVertexArray();
    this.finish = makeFinish(gl);
    this.made = new Map(); // by method's key: its program and uniforms
    this.maps = new Map(); // by size: a shadow map and the light it is of
    this.surfaces = new Map(); // by size: surface points and the view they are of
    this.targets = new Map(); // by name: sums of answers
  }

  // mesh: vertices (3 a vertex) and faces; ground: its height along `up`, or null.
  setMesh(mesh, ground) {
    const { gl, up, groundRadius } = this, { positions, vertexNormals, faceNormals } = corners(mesh);
    Object.assign(this, { vertices: mesh.vertices, positions, height: ground });
    this.object = makeVertices(gl, this.surface, {
      position: positions, normal: vertexNormals, faceNormal: faceNormals,
    });
    this.occluder = makeVertices(gl, this.heights, { position: positions });
    this.rim = ground === null ? 0 : groundRadius ** 2 + ground ** 2;
    this.ground = ground === null ? null : makeVertices(gl, this.surface, groundQuad(up, ground, groundRadius));
    this.dropMaps();
    for (const surface of this.surfaces.values()) surface.seen = "";
    for (const [key, { method }] of this.made) if (method.ofMesh) this.made.delete(key);
  }

  // The surface points that a viewpoint sees, kept while it stands still: of the last two sizes.
  look(view, [width, height]) {
    const { gl, surfaces } = this;
    const points = surfaces.get(`${width} × ${height}`)
      ?? makeTarget(gl, [BITS, BITS, NORMALS], width, height, true);
    keepNewest(surfaces, `${width} × ${height}`, points);
    const seen = viewText(view);
    if (seen === points.seen) return points.textures;
    points.seen = seen;
    gl.bindFramebuffer(gl.FRAMEBUFFER, points.framebuffer);
    gl.viewport(0, 0, width, height);
    for (let i = 0; i < 2; i++) gl.clearBufferuiv(gl.COLOR, i, [0, 0, 0, 0]);
    gl.clearBufferfv(gl.COLOR, 2, [0, 0, 0, 0]);
    gl.clearBufferfv(gl.DEPTH, 0, [1]);
    const camera = {
      camera: cameraMatrix(view, width / height), pixels: pixelMatrix(view, width, height),
      eye: view.eye, rim: this.rim, drop: (this.height ?? 0) - dot(view.eye, this.up),
    };
    const draw = (mesh, kind) => {
      setUniforms(gl, this.surface, { ...camera, kind });
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
    const target = known ?? makeTarget(gl, [ONE_FLOATS_BITS], size, size, true);
    const sizes = { basis: rows.flat(), corner, side, highest: high[2] };
    gl.bindFramebuffer(gl.FRAMEBUFFER, target.framebuffer);
    gl.viewport(0, 0, size, size);
    clearFloat(gl, -1e30);
    gl.clearBufferfv(gl.DEPTH, 0, [1]);
    gl.enable(gl.DEPTH_TEST);
    setUniforms(gl, this.heights, sizes);
    gl.bindVertexArray(this.occluder.vertices);
    gl.drawArrays(gl.TRIANGLES, 0, this.occluder.count);
    gl.disable(gl.DEPTH_TEST);
    target.light = [...light];
    target.uniforms = { heights: target.textures[0], ...sizes };
    keepNewest(this.maps, size, target);
    return target.uniforms;
  }

  // A method's program, and its uniforms of a light; made when it is first needed.
  prepare(method) {
    if (!this.made.has(method.key)) {
      const source = ["floats", "discs", "visibility_frag", ...method.sources].map((name) => this.shaders[name]).join("\n");
      const program = makeProgram(this.gl, this.shaders.screen_vert, source, method.constants);
      this.made.set(method.key, { method, program, uniforms: method.make(this) });
    }
    return this.made.get(method.key);
  }

  // A method's answers at the points of a viewpoint, in some columns, and in rows from the top;
  // `rays` of them from the `first` on, added to those before.
  answer(method, name, { view, size, sun }, { from = 0, to = size[0], top = 0, end = size[1], first = 0, rays = 1 } = {}) {
    const { gl } = this, [points, faceNormals] = this.look(view, size);
    const { program, uniforms } = this.prepare(method);
    const values = uniforms(sun.light); // first: a map is drawn for them
    let target = this.targets.get(name);
    if (target?.width !== size[0] || target.height !== size[1]) {
      target?.free();
      this.targets.set(name, target = makeTarget(gl, [SUMS], ...size));
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, target.framebuffer);
    gl.viewport(0, 0, ...size);
    gl.enable(gl.SCISSOR_TEST);
    gl.scissor(from, size[1] - end, Math.max(0, to - from), end - top);
    if (first > 0) gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE);
    setUniforms(gl, program, { points, faceNormals, sun: sun.light, slope: sun.slope, first, rays, ...values });
    gl.bindVertexArray(this.screen);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.disable(gl.BLEND);
    gl.disable(gl.SCISSOR_TEST);
  }

  // Visibilities of some rows, those from below first; −1 where there is no surface.
  read(name, low = 0, high = Infinity) {
    const { gl } = this, { framebuffer, width, height } = this.targets.get(name);
    const rows = Math.min(high, height) - low, sums = new Float32Array(4 * width * rows);
    gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
    gl.readPixels(0, low, width, rows, gl.RGBA, gl.FLOAT, sums);
    return Float32Array.from({ length: width * rows }, (_, i) => sums[4 * i + 1] ? sums[4 * i] / sums[4 * i + 1] : -1);
  }

  // The picture, or some of its rows from the top, of the answers by these names.
  show({ left, right, reference }, { view, sun }, { divider, errors }, top = 0, end = this.canvas.height) {
    const { gl, canvas, targets } = this, [any] = targets.values();
    // Answers that are not seen need not be there.
    const texture = (name) => (targets.get(name) ?? any).textures[0];
    const seen = viewText(view), finest = [...this.surfaces.values()]
      .filter((surface) => surface.seen === seen).sort((a, b) => b.width - a.width)[0];
    keepNewest(this.surfaces, `${finest.width} × ${finest.height}`, finest);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.enable(gl.SCISSOR_TEST);
    gl.scissor(0, canvas.height - end, canvas.width, end - top);
    setUniforms(gl, this.picture, {
      shadingNormals: finest.textures[2], left: texture(left), right: texture(right),
      reference: texture(reference), sun: sun.light, up: this.up, errors, divider,
      canvas: [canvas.width, canvas.height],
    });
    gl.bindVertexArray(this.screen);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.disable(gl.SCISSOR_TEST);
  }
}

const viewText = ({ eye, target, up, fov }) => JSON.stringify([eye, target, up, fov]);

// Puts a target into a map of targets, of which the last two are kept.
function keepNewest(targets, key, target) {
  targets.delete(key);
  targets.set(key, target);
  const [oldest] = targets.keys();
  if (targets.size <= 2) return;
  targets.get(oldest).free();
  targets.delete(oldest);
}

// Two triangles that hold the ground's disc.
function groundQuad(up, height, radius) {
  const [u, v] = basisOf(up), middle = up.map((x) => x * height), reach = 2 * radius;
  const at = (a, b) => plus(plus(middle, u, a * reach), v, b * reach);
  const position = [[-1, -1], [1, -1], [1, 1], [-1, -1], [1, 1], [-1, 1]].flatMap(([a, b]) => at(a, b));
  const normal = Float32Array.from({ length: 18 }, (_, i) => up[i % 3]);
  return { position: Float32Array.from(position), normal, faceNormal: normal };
}

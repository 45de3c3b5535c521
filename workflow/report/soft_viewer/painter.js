// Draws both sides in steps between animation frames: small while something moves, then larger and
// larger, and the reference by more and more rays; a movement stops it.

const STEP_MS = 24;    // of an animation frame, for our steps
const MOVING_MS = 70;  // of a picture while something moves
const RESTING_MS = 2000; // of a picture at rest
const HEIGHTS = [64, 96, 128, 192, 256, 384, 512];
const TRUTHS = [4, 16, 64, 256]; // rays of the reference, one after the other
const MOST_FINE = 1080; // rows of a picture
const SIDES = ["left", "right"];

class Painter {
  // aspect: width by height of the canvas. told: gets what is known of a side: size, ms, error, rays.
  constructor(renderer, methods, { state, detail, aspect, told, guarded }) {
    Object.assign(this, { renderer, methods, state, detail, aspect, told, guarded });
    this.cost = new Map(); // by method: milliseconds a pixel
    this.job = null;
    this.due = 0;
  }

  // Something has changed. A picture begun while moving is finished first, or none ever would be.
  ask(moving) {
    this.again = moving;
    if (this.job === null || !this.job.moving) this.#start(moving);
    this.due ||= requestAnimationFrame(() => this.#tick());
  }

  // For tests, which ask for answers of other sizes.
  stop() {
    cancelAnimationFrame(this.due);
    Object.assign(this, { due: 0, job: null, again: null });
  }

  #start(moving) {
    this.again = null;
    this.job = { moving, steps: this.#pictures(moving), waited: 0 };
  }

  #tick() {
    this.due = 0;
    this.guarded(() => {
      const begun = performance.now();
      do {
        const { done } = this.job.steps.next();
        if (done) {
          this.job = null;
          if (this.again !== null && this.again !== undefined) this.#start(this.again);
        }
      } while (this.job && performance.now() - begun < STEP_MS);
      if (this.job) this.due = requestAnimationFrame(() => this.#tick());
    });
  }

  // At least as wide as the canvas, so that every size shows the same from bottom to top.
  sizeOf(height) {
    return [64 * Math.ceil(height * this.aspect() / 64), height];
  }

  #predicted([width, height]) {
    const keys = new Set(SIDES.map((side) => this.state()[side]));
    return [...keys].reduce((sum, key) => sum + (this.cost.get(key) ?? Infinity) * width * height, 0);
  }

  *#pictures(moving) {
    const most = this.detail(), heights = HEIGHTS.filter((height) => height <= most);
    const within = (budget) => heights.filter((height) => this.#predicted(this.sizeOf(height)) <= budget).at(-1) ?? heights[0];
    const first = this.state().look === "error" ? TRUTHS[1] : TRUTHS[0]; // of fewer rays the error is their noise
    let height = within(MOVING_MS);
    yield* this.#picture(height, first, { moving });
    if (moving) return;
    // As large as there is patience for, which the smaller ones tell.
    for (const larger of heights.filter((other) => other > height)) {
      if (this.#predicted(this.sizeOf(larger)) > RESTING_MS) break;
      height = larger;
      yield* this.#picture(height, first);
    }
    for (const count of TRUTHS.slice(1)) yield* this.#picture(height, count, { again: true });
  }

  // One picture of both sides. again: only what more rays change is drawn.
  *#picture(height, rays, { moving = false, again = false } = {}) {
    const size = this.sizeOf(height), state = { ...this.state(), size, truth: rays }, needs = state.look === "error";
    const reference = needs || again ? yield* this.#timed(this.methods.truth, state) : null;
    for (const side of SIDES) {
      const method = this.methods[state[side]];
      const answer = again && method.key !== "truth" && this.answers?.[side] || (yield* this.#timed(method, state));
      this.answers = { ...this.answers, [side]: answer };
      this.#shade(side, answer, reference, state, moving);
    }
    this.show(size);
    if (again) yield* this.#compare(height, rays);
    else for (const side of SIDES) this.told(side, { size, ms: this.ms[state[side]], rays: state[side] === "truth" ? rays : null });
    yield;
  }

  *#timed(method, state) {
    const steps = method.answer(this.renderer, state);
    let total = 0;
    for (;;) {
      const begun = performance.now(), { done, value } = steps.next();
      this.renderer.finish();
      total += performance.now() - begun;
      if (done) {
        this.ms = { ...this.ms, [method.key]: total };
        const pixels = state.size[0] * state.size[1], first = !this.cost.has(method.key);
        // The first holds the compilation of its shaders.
        this.cost.set(method.key, first ? Math.min(total, MOVING_MS) / pixels : total / pixels);
        return value;
      }
      yield;
    }
  }

  // As fine as the canvas at rest: surfaces are cheap, answers are not.
  #shade(side, { texture, channel }, reference, state, moving) {
    const { renderer } = this, fine = moving ? state.size : this.#fineSize(state.size);
    const coarse = renderer.surfaces(state), surfaces = moving ? coarse : renderer.surfaces({ ...state, size: fine }, "fine");
    const { points, normals, colours } = surfaces;
    renderer.fill(["picture_frag"], this.#pictureTarget(side, fine), {
      points, normals, colours, coarsePoints: coarse.points, coarseNormals: coarse.normals, answer: texture,
      reference: (reference ?? { texture }).texture, centre: state.light.centre,
      channel: [0, 1, 2, 3].map((k) => Number(k === channel)), look: LOOKS.indexOf(state.look),
    });
  }

  #fineSize(size) {
    const { height } = this.renderer.canvas, scale = Math.max(1, Math.min(height, MOST_FINE) / this.cover(size)[1] / size[1]);
    return size.map((side) => Math.round(scale * side));
  }

  #pictureTarget(side, size) {
    const { renderer: { gl } } = this, target = this.renderer.target(`picture_${side}`, [BYTES], ...size);
    gl.bindTexture(gl.TEXTURE_2D, target.textures[0].texture);
    for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, filter, gl.LINEAR);
    return target;
  }

  // Shares of the pictures that cover the canvas.
  cover(size) {
    return [this.aspect() * size[1] / size[0], 1];
  }

  show(size) {
    this.shown = size;
    this.draw();
  }

  draw() {
    const { renderer, shown } = this, { canvas, targets } = renderer;
    if (!shown) return;
    renderer.fill(["screen_frag"], null, {
      left: targets.picture_left.textures[0], right: targets.picture_right.textures[0],
      canvasSize: [canvas.width, canvas.height], cover: this.cover(shown), divider: this.state().divider / 100,
    });
  }

  // How far each side is from the reference: the mean squared difference where there is a surface.
  *#compare(height, rays) {
    const size = this.sizeOf(height), { renderer } = this;
    const exact = renderer.read(renderer.targets[`truth_${renderer.kept.truth.side}`].textures[0], size);
    yield;
    const points = renderer.read(renderer.targets.surfaces.textures[0], size);
    for (const side of SIDES) {
      yield;
      const { texture, channel } = this.answers[side], answer = renderer.read(texture, size);
      let sum = 0, count = 0;
      for (let i = 0; i < exact.length; i += 4) {
        if (points[i + 3] === 0) continue;
        sum += (clamped(answer[i + channel], 0, 1) - exact[i]) ** 2;
        count++;
      }
      const key = this.state()[side];
      this.told(side, { size, ms: key === "truth" ? null : this.ms[key], error: key === "truth" ? null : sum / Math.max(1, count), rays });
    }
  }
}

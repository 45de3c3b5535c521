// A camera that goes round its target by mouse, touch and keyboard, and comes to rest softly.

const SLOWING = 7.7; // a second: of a movement a half is left after 0.09 s
const LOWEST = 0.03; // over the ground, in radii
const FARTHEST = 15; // of the eye and of the target from the middle, in radii

class Orbit {
  // moved: called whenever the view has changed.
  constructor(element, { up, ground }, moved) {
    Object.assign(this, { element, up, ground, moved, pointers: new Map(), last: 0 });
    this.speed = [0, 0, 0, 0, 0]; // a second: angles right and up; shares of the frame; log of the zoom
    element.addEventListener("contextmenu", (event) => event.preventDefault());
    element.addEventListener("wheel", (event) => {
      // In a page the wheel is the page's, until the picture is chosen.
      const chosen = window.parent === window || event.ctrlKey || document.activeElement === element;
      if (!chosen) return;
      event.preventDefault();
      this.#push([0, 0, 0, 0, clamped(event.deltaY, -200, 200) / 500]);
    }, { passive: false });
    element.addEventListener("pointerdown", (event) => {
      element.setPointerCapture(event.pointerId);
      this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
      this.speed.fill(0);
    });
    element.addEventListener("pointermove", (event) => this.#drag(event));
    for (const end of ["pointerup", "pointercancel"]) {
      element.addEventListener(end, (event) => {
        this.pointers.delete(event.pointerId);
        if (performance.now() - this.last > 60) this.speed.fill(0);
        this.#coast();
      });
    }
    element.addEventListener("keydown", (event) => this.#key(event));
  }

  set(view) {
    this.view = { ...view, up: this.up };
    this.speed.fill(0);
  }

  #drag(event) {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const now = [event.clientX, event.clientY], size = this.element.clientHeight;
    const [x, y] = [(now[0] - before[0]) / size, (now[1] - before[1]) / size];
    const others = [...this.pointers].filter(([id]) => id !== event.pointerId).map(([, at]) => at);
    this.pointers.set(event.pointerId, now);
    let step = [-4 * x, 4 * y, 0, 0, 0];
    if (others.length) {
      const gap = (at) => Math.hypot(at[0] - others[0][0], at[1] - others[0][1]) || 1;
      step = [0, 0, x / 2, y / 2, Math.log(gap(before) / gap(now))];
    } else if (event.buttons & 2 || event.shiftKey) {
      step = [0, 0, x, y, 0];
    }
    const seconds = clamped((performance.now() - this.last) / 1000, 0.008, 0.1);
    this.last = performance.now();
    this.speed = step.map((way) => way / seconds);
    this.#move(step);
  }

  #key(event) {
    const ways = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    const zooms = { "+": -0.1, "=": -0.1, "-": 0.1 };
    if (event.key in ways) {
      const [right, upward] = ways[event.key];
      this.#push(event.shiftKey
        ? [0, 0, -0.05 * right, 0.05 * upward, 0] : [0.1 * right, 0.1 * upward, 0, 0, 0]);
    } else if (event.key in zooms) this.#push([0, 0, 0, 0, zooms[event.key]]);
    else return;
    event.preventDefault();
  }

  // A movement by so much, spread over its slowing down.
  #push(way) {
    this.speed = this.speed.map((speed, i) => speed + SLOWING * way[i]);
    this.moved();
    this.#coast();
  }

  #coast() {
    if (this.coasting) return;
    let before = performance.now();
    const step = (now) => {
      const seconds = clamped((now - before) / 1000, 0, 0.25);
      before = now;
      this.coasting = this.pointers.size === 0 && Math.max(...this.speed.map(Math.abs)) > 0.002;
      if (!this.coasting) return;
      const left = Math.exp(-SLOWING * seconds);
      this.#move(this.speed.map((speed) => speed * (1 - left) / SLOWING));
      this.speed = this.speed.map((speed) => speed * left);
      requestAnimationFrame(step);
    };
    this.coasting = true;
    requestAnimationFrame(step);
  }

  // By angles to the right and up, about the target; by shares of the frame's height; nearer.
  #move([right, upward, across, down, farther]) {
    const { fov } = this.view;
    let { eye, target } = this.view, away = plus(eye, target, -1);
    const distance = clamped(Math.hypot(...away) * Math.exp(farther), 0.15, FARTHEST);
    const [u, v] = basisOf(this.up), azimuth = Math.atan2(dot(away, v), dot(away, u)) + right;
    const least = this.ground === null ? -Infinity : this.ground + LOWEST - dot(target, this.up);
    const low = Math.max(-1.5, Math.asin(clamped(least / distance, -1, 1)));
    const height = Math.asin(clamped(dot(unit(away), this.up), -1, 1));
    const elevation = clamped(height + upward, low, 1.55);
    const level = plus(u.map((x) => x * Math.cos(azimuth)), v, Math.sin(azimuth));
    away = plus(level.map((x) => x * Math.cos(elevation)), this.up, Math.sin(elevation));
    const side = unit(cross(this.up, away)), top = cross(away, side);
    const reach = 2 * distance * Math.tan(fov * Math.PI / 360);
    target = plus(plus(target, side, -across * reach), top, down * reach);
    if (Math.hypot(...target) > FARTHEST) target = unit(target).map((x) => x * FARTHEST);
    eye = plus(target, away, distance);
    const lift = this.ground === null ? 0 : this.ground + LOWEST - dot(eye, this.up);
    this.view = { ...this.view, eye: plus(eye, this.up, Math.max(0, lift)), target };
    this.moved();
  }
}

// A camera that goes round its target by mouse, touch and keyboard, and comes to rest softly.

const REST = 0.88; // of a movement, what is left after a sixtieth of a second
const LOWEST = 0.03; // over the ground, in radii

class Orbit {
  // moved: called whenever the view has changed, with whether it is still moving.
  constructor(element, { up, ground }, moved) {
    Object.assign(this, { element, up, ground, moved, speed: [0, 0], pointers: new Map(), last: 0 });
    element.addEventListener("contextmenu", (event) => event.preventDefault());
    element.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.zoom(Math.exp(clamped(event.deltaY, -200, 200) / 500));
    }, { passive: false });
    element.addEventListener("pointerdown", (event) => {
      element.setPointerCapture(event.pointerId);
      this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
      this.speed = [0, 0];
    });
    element.addEventListener("pointermove", (event) => this.#drag(event));
    for (const end of ["pointerup", "pointercancel"]) {
      element.addEventListener(end, (event) => {
        this.pointers.delete(event.pointerId);
        this.#coast();
      });
    }
    element.addEventListener("keydown", (event) => this.#key(event));
  }

  set(view) {
    this.view = { ...view, up: this.up };
    this.speed = [0, 0];
    this.moved(false);
  }

  #drag(event) {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const now = [event.clientX, event.clientY], size = this.element.clientHeight;
    const [x, y] = [(now[0] - before[0]) / size, (now[1] - before[1]) / size];
    const others = [...this.pointers].filter(([id]) => id !== event.pointerId).map(([, at]) => at);
    this.pointers.set(event.pointerId, now);
    if (others.length) {
      const gap = (at) => Math.hypot(at[0] - others[0][0], at[1] - others[0][1]) || 1;
      this.pan(x / 2, y / 2);
      this.zoom(gap(before) / gap(now));
    } else if (event.buttons & 2 || event.shiftKey) {
      this.pan(x, y);
    } else {
      this.speed = [-4 * x, 4 * y];
      this.last = performance.now();
      this.turn(...this.speed);
    }
  }

  // A pointer that was still moving when it was lifted gives its speed to the view.
  #coast() {
    if (performance.now() - this.last > 60) this.speed = [0, 0];
    const step = () => {
      if (this.pointers.size || Math.hypot(...this.speed) < 1e-4) {
        this.moved(false);
        return;
      }
      this.speed = this.speed.map((x) => x * REST);
      this.turn(...this.speed);
      requestAnimationFrame(step);
    };
    step();
  }

  #key(event) {
    const turns = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] };
    const zooms = { "+": 0.9, "=": 0.9, "-": 1 / 0.9 };
    if (event.key in turns && event.shiftKey) this.pan(...turns[event.key].map((x) => -x / 2));
    else if (event.key in turns) this.turn(...turns[event.key]);
    else if (event.key in zooms) this.zoom(zooms[event.key]);
    else return;
    event.preventDefault();
    this.moved(false);
  }

  // By angles to the right and up, about the target.
  turn(right, upward) {
    const { eye, target } = this.view, away = plus(eye, target, -1), distance = Math.hypot(...away);
    const [u, v] = basisOf(this.up), azimuth = Math.atan2(dot(away, v), dot(away, u)) + right;
    const least = this.ground === null ? -Infinity : this.ground + LOWEST - dot(target, this.up);
    const low = Math.max(-1.5, Math.asin(clamped(least / distance, -1, 1)));
    const elevation = clamped(Math.asin(clamped(dot(away, this.up) / distance, -1, 1)) + upward, low, 1.55);
    const level = plus(u.map((x) => x * Math.cos(azimuth)), v, Math.sin(azimuth));
    const turned = plus(level.map((x) => x * Math.cos(elevation)), this.up, Math.sin(elevation));
    this.#look(plus(target, turned, distance), target);
  }

  pan(right, down) {
    const { eye, target, fov } = this.view, away = plus(eye, target, -1);
    const across = unit(cross(this.up, away)), upward = unit(cross(away, across));
    const reach = 2 * Math.hypot(...away) * Math.tan(fov * Math.PI / 360);
    const moved = plus(across.map((x) => -x * right * reach), upward, down * reach);
    this.#look(plus(eye, moved), plus(target, moved));
  }

  zoom(factor) {
    const { eye, target } = this.view, away = plus(eye, target, -1);
    const distance = clamped(factor * Math.hypot(...away), 0.15, 15);
    this.#look(plus(target, unit(away), distance), target);
    this.moved(false);
  }

  #look(eye, target) {
    const low = this.ground === null ? 0 : this.ground + LOWEST - dot(eye, this.up);
    const lift = Math.max(0, low);
    this.view = { ...this.view, eye: plus(eye, this.up, lift), target };
    this.moved(true);
  }
}

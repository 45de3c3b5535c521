// The light on a dome seen from above: the middle is the zenith, the rim the horizon, and what
// the camera looks at lies upwards. It stays in the scene's domain (scenes/lights.py).

const SVG = "http://www.w3.org/2000/svg";

class Dome {
  constructor(svg, { up, domain }, moved) {
    Object.assign(this, { svg, up, domain, moved, lowest: domain.min_elevation_deg * Math.PI / 180 });
    const draw = (name, attributes) => {
      const element = svg.appendChild(document.createElementNS(SVG, name));
      for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
      return element;
    };
    draw("circle", { r: 1, class: "horizon" });
    this.allowed = draw(domain.domain === "sphere" ? "circle" : "path", { class: "allowed" });
    this.sun = draw("circle", { r: 0.11, class: "sun" });
    const point = (event) => {
      const box = svg.getBoundingClientRect(), size = box.width / 2.2;
      this.#to((event.clientX - box.left) / size - 1.1, 1.1 - (event.clientY - box.top) / size);
    };
    svg.addEventListener("pointerdown", (event) => {
      svg.setPointerCapture(event.pointerId);
      this.held = true;
      point(event);
    });
    svg.addEventListener("pointermove", (event) => { if (this.held) point(event); });
    for (const end of ["pointerup", "pointercancel"]) {
      svg.addEventListener(end, () => { this.held = false; });
    }
    svg.addEventListener("keydown", (event) => {
      const steps = { ArrowLeft: [-0.06, 0], ArrowRight: [0.06, 0], ArrowUp: [0, 0.06], ArrowDown: [0, -0.06] };
      if (!(event.key in steps)) return;
      event.preventDefault();
      const [x, y] = this.#place(this.light), [right, ahead] = steps[event.key];
      this.#to(x + right, y + ahead);
    });
  }

  // The nearest direction that the domain allows.
  #allowed(light) {
    if (this.domain.domain === "single_axis") {
      const [across] = this.#axes(), angle = Math.atan2(dot(light, across), dot(light, this.up));
      return this.#onArc(clamped(angle, this.lowest - Math.PI / 2, Math.PI / 2 - this.lowest));
    }
    const height = dot(light, this.up);
    if (height >= Math.sin(this.lowest)) return light;
    const level = plus(light, this.up, -height);
    const around = Math.hypot(...level) > 1e-6 ? unit(level) : basisOf(this.up)[0];
    return plus(around.map((x) => x * Math.cos(this.lowest)), this.up, Math.sin(this.lowest));
  }

  // Of the sun's path: across, in which it goes, and the axis that it goes about.
  #axes() {
    const axis = [0, 1, 2].map((i) => Number("xyz"[i] === (this.domain.axis ?? "")));
    const about = this.domain.axis ? axis : basisOf(this.up)[0];
    return [cross(about, this.up), about];
  }

  #onArc(angle) {
    const [across] = this.#axes();
    return plus(this.up.map((x) => x * Math.cos(angle)), across, Math.sin(angle));
  }

  // A day's light at a share of it: along the arc, on a sphere over a path that leans.
  atTime(share) {
    const half = Math.PI / 2 - this.lowest, light = this.#onArc((2 * share - 1) * half);
    if (this.domain.domain === "single_axis") return light;
    const [, about] = this.#axes();
    return this.#allowed(unit(plus(light, about, 0.45)));
  }

  // The share of a day at which the light is nearest to where it stands.
  time() {
    const shares = Array.from({ length: 200 }, (_, i) => i / 200);
    const near = shares.map((share) => dot(this.atTime(share), this.light));
    return shares[near.indexOf(Math.max(...near))];
  }

  // What is to the right of the camera and ahead of it.
  #sides() {
    const right = unit(cross(this.ahead, this.up));
    return [right, cross(this.up, right)];
  }

  // On the drawing: to the right, and upwards. Angles from the zenith are drawn as lengths.
  #place(light) {
    const [right, ahead] = this.#sides(), x = dot(light, right), y = dot(light, ahead);
    const level = Math.hypot(x, y), length = Math.atan2(level, dot(light, this.up)) / (Math.PI / 2);
    return level < 1e-9 ? [0, 0] : [x / level * length, y / level * length];
  }

  #to(x, y) {
    const [right, ahead] = this.#sides(), length = Math.min(1, Math.hypot(x, y)), angle = length * Math.PI / 2;
    const level = unit(plus(right.map((a) => a * (x || 1e-9)), ahead, y));
    this.set(plus(this.up.map((a) => a * Math.cos(angle)), level, Math.sin(angle)));
    this.moved();
  }

  set(light) {
    this.light = unit(this.#allowed(unit(light)));
    this.draw();
  }

  // view: the camera that the drawing is turned by.
  turn({ eye, target }) {
    const ahead = plus(target, eye, -1), level = plus(ahead, this.up, -dot(ahead, this.up));
    if (Math.hypot(...level) > 1e-6) this.ahead = unit(level);
    if (this.light) this.draw();
  }

  draw() {
    const [x, y] = this.#place(this.light), text = (number) => number.toFixed(3);
    this.sun.setAttribute("cx", text(x));
    this.sun.setAttribute("cy", text(-y));
    const elevation = Math.asin(clamped(dot(this.light, this.up), -1, 1)) * 180 / Math.PI;
    this.svg.setAttribute("aria-valuenow", elevation.toFixed(0));
    this.svg.setAttribute("aria-valuetext", `light ${elevation.toFixed(0)} degrees above the horizon`);
    if (this.domain.domain === "sphere") {
      this.allowed.setAttribute("r", text(1 - this.lowest / (Math.PI / 2)));
      return;
    }
    const half = Math.PI / 2 - this.lowest, steps = Array.from({ length: 25 }, (_, i) => (i / 12 - 1) * half);
    const points = steps.map((angle) => this.#place(this.#onArc(angle)).map((a, i) => text(i ? -a : a)));
    this.allowed.setAttribute("d", `M${points.join("L")}`);
  }
}

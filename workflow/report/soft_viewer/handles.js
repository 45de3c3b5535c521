// The light and the object, dragged on the picture.

// The ray through a place of the canvas, from its left and its top in shares: [eye, direction].
function rayThrough(view, aspect, cover, [x, y]) {
  const [right, upward, forward] = cameraAxes(view), half = Math.tan(view.fov * Math.PI / 360);
  const across = (2 * x - 1) * cover[0] * half * aspect, up = (1 - 2 * y) * cover[1] * half;
  return [view.eye, plus(plus(forward, right, across), upward, up)];
}

// Where a point lies on the canvas, in shares, and its depth; null behind the camera.
function placeOnCanvas(view, aspect, cover, point) {
  const offset = plus(point, view.eye, -1), [x, y, depth] = cameraAxes(view).map((axis) => dot(axis, offset));
  if (depth <= 0.02) return null;
  const half = Math.tan(view.fov * Math.PI / 360);
  return { x: 0.5 + x / depth / (half * aspect) / cover[0] / 2, y: 0.5 - y / depth / half / cover[1] / 2, depth };
}

// A handle that is dragged. options: `lens()`, the view, aspect and cover; `at()`, the point; `moved(point)`;
// `plane()`, a point's plane normal, along which it keeps its place.
class Handle {
  constructor(element, stage, options) {
    Object.assign(this, { element, stage, ...options });
    element.addEventListener("pointerdown", (event) => {
      element.setPointerCapture(event.pointerId);
      this.held = true;
      event.preventDefault();
      element.focus();
    });
    element.addEventListener("pointermove", (event) => { if (this.held) this.#drag(event); });
    for (const end of ["pointerup", "pointercancel"]) element.addEventListener(end, () => { this.held = false; });
    element.addEventListener("keydown", (event) => this.#key(event));
  }

  #drag(event) {
    const box = this.stage.getBoundingClientRect(), point = this.at();
    const place = [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
    const { view, aspect, cover } = this.lens(), [eye, way] = rayThrough(view, aspect, cover, place);
    const normal = this.plane(), slope = dot(way, normal);
    if (Math.abs(slope) < 0.05) return;
    const t = dot(plus(point, eye, -1), normal) / slope;
    if (t > 0) this.moved(plus(eye, way, t));
  }

  #key(event) {
    const [right, , forward] = cameraAxes(this.lens().view), level = unit([forward[0], 0, forward[2]]);
    const steps = {
      ArrowLeft: right.map((x) => -x), ArrowRight: right, ArrowUp: level, ArrowDown: level.map((x) => -x),
      PageUp: [0, 1, 0], PageDown: [0, -1, 0],
    };
    if (!(event.key in steps)) return;
    event.preventDefault();
    event.stopPropagation();
    this.moved(plus(this.at(), steps[event.key], 0.08));
  }

  draw() {
    const { view, aspect, cover } = this.lens(), place = placeOnCanvas(view, aspect, cover, this.at());
    this.element.hidden = !place;
    if (!place) return;
    const [x, y] = [place.x, place.y].map((share) => clamped(share, 0.02, 0.98));
    this.element.classList.toggle("outside", x !== place.x || y !== place.y); // it waits at the rim
    this.element.style.left = `${100 * x}%`;
    this.element.style.top = `${100 * y}%`;
    const size = 2 * this.radius() / place.depth / (2 * Math.tan(view.fov * Math.PI / 360) * cover[1]);
    this.element.style.setProperty("--across", `${Math.min(200, size * this.stage.clientHeight).toFixed(1)}px`);
  }
}

// The soft viewer: two methods under the same area light on both sides of a divider, live.

const PLAY_SECONDS = 8; // of the light's round
const WALK = { w: [0, 1], s: [0, -1], a: [-1, 0], d: [1, 0] }; // right, ahead

async function startSoftViewer(root, data) {
  const find = (selector) => root.querySelector(selector), canvas = find("canvas"), stage = find(".stage");
  const scene = await unpackScene(data.scene, data.fields);
  const networks = await Promise.all(data.networks.map(async (network) => (
    { ...network, arrays: { weights: await unpack(network.arrays.weights) } })));
  const all = allMethods(networks, scene.fields), methods = Object.fromEntries(all.map((method) => [method.key, method]));
  const renderer = new Renderer(canvas, data.shaders, scene), { gl } = renderer;
  const first = data.views[0], start = ({ eye, target, fov, light }) => (
    { view: { eye, target, fov, up: [0, 1, 0] }, light: { centre: light, radius: data.radius / 2 } });
  const state = {
    left: "hard", right: networks.at(-1)?.key ?? "pcss", divider: 50, look: "shaded", resolution: data.resolution,
    move: [0, 0, 0], ...start(first), ...pick(stateOf(location.hash.slice(1), all.map(({ key }) => key), data.radius)),
  };
  let rest = 0, moved = 0, playing = null, detail = "auto", touched = false;

  function pick(values) {
    return values.view ? { ...values, view: { ...values.view, up: [0, 1, 0] } } : values;
  }

  const aspect = () => canvas.width / canvas.height;
  const painter = new Painter(renderer, methods, {
    state: () => state, aspect, guarded, told: (side, facts) => tell(side, facts),
    detail: () => detail === "auto" ? clamped(2 ** Math.floor(Math.log2(canvas.height)), 64, 512) : Number(detail),
  });
  const lens = () => {
    const size = painter.shown ?? painter.sizeOf(128);
    return { view: state.view, aspect: size[0] / size[1], cover: painter.cover(size) };
  };
  const lightHandle = new Handle(find(".light"), stage, {
    lens, at: () => state.light.centre, radius: () => state.light.radius, plane: () => cameraAxes(state.view)[2],
    moved: (centre) => { stop(); moveLight(centre); },
  });
  const objectAt = () => plus(scene.rest, [state.move[0], 0, state.move[1]]);
  const objectHandle = new Handle(find(".object"), stage, {
    lens, at: objectAt, radius: () => 0, plane: () => [0, 1, 0],
    moved: (point) => {
      const [low, high] = data.scene.bounds, [x, , z] = point.map((value, k) => clamped(value, low[k], high[k]));
      state.move = [x - scene.rest[0], z - scene.rest[2], state.move[2]];
      changed();
    },
  });
  const orbit = new Orbit(canvas, { up: [0, 1, 0], ground: data.scene.bounds[0][1] }, () => {
    state.view = { ...orbit.view };
    find("select.view").selectedIndex = -1;
    changed();
  });

  function moveLight(centre) {
    const [low, high] = data.scene.bounds;
    state.light = { ...state.light, centre: centre.map((x, k) => clamped(x, low[k], high[k])) };
    find(".nudge").hidden = true;
    changed();
  }

  // Something moved; a quarter of a second after the last the picture is refined.
  function changed(byReader = true) {
    touched ||= byReader;
    root.dataset.moving = "true";
    place();
    painter.ask(true);
    clearTimeout(rest);
    rest = setTimeout(() => {
      if (playing) return;
      painter.ask(false);
      if (touched || window.parent === window) writeAddress(stateText(state));
      root.dataset.moving = "false"; // tests wait for it
    }, 250);
  }

  function guarded(step) {
    try {
      step();
    } catch (error) {
      fail(root, error);
    }
  }

  function tell(side, { size, ms, error, rays }) {
    const method = methods[state[side]], facts = [];
    const map = method.usesMap ? 24 * state.resolution ** 2 : 0; // six faces of four bytes
    if (method.stored) facts.push(`${KIB(method.stored)} of ${method.storedAs}`);
    if (map) facts.push(`map ${KIB(map)}`);
    if (ms !== null && ms !== undefined) facts.push(`${ms.toFixed(0)} ms at ${size.join(" × ")}`);
    if (rays) facts.push(error === undefined || error === null ? `${rays} rays a pixel` : `error ${(1e4 * error).toFixed(1)} × 10⁻⁴ of ${rays} rays`);
    const beyond = method.reach && state.light.radius > method.reach * 1.0001;
    if (beyond) facts.push(`trained on lights up to ${centimetres(method.reach)}: beyond, it guesses`);
    find(`.facts.${side}`).textContent = `${method.name}: ${facts.join(" · ")}`;
    find(".rate").textContent = `${size.join(" × ")}`;
  }

  const centimetres = (metres) => `${(100 * metres).toFixed(metres < 0.1 ? 1 : 0)} cm`;

  function place() {
    find(".over").style.left = `${state.divider}%`;
    find(".over").setAttribute("aria-valuenow", state.divider.toFixed(0));
    for (const side of SIDES) find(`select.${side}`).value = state[side];
    find("select.look").value = state.look;
    find(".legend").hidden = state.look !== "error";
    find(".size").value = String(Math.round(1000 * state.light.radius / data.radius));
    find(".size-text").textContent = state.light.radius ? `radius ${centimetres(state.light.radius)}` : "a point";
    find(".turn").value = String(Math.round(state.move[2] * 180 / Math.PI));
    find(".play").setAttribute("aria-pressed", String(Boolean(playing)));
    lightHandle.draw();
    objectHandle.draw();
  }

  function take(values) {
    Object.assign(state, values);
    if (values.view) orbit.set(values.view);
    changed();
  }

  // The light goes round its place, or no longer.
  function stop() {
    if (!playing) return;
    cancelAnimationFrame(playing.request);
    playing = null;
    changed();
  }
  function play() {
    if (playing) return stop();
    const centre = state.light.centre, begun = performance.now(), reach = 0.12 * scene.size;
    const step = (now) => {
      const angle = 2 * Math.PI * (now - begun) / 1000 / PLAY_SECONDS;
      moveLight(plus(centre, [reach * Math.sin(angle), 0, reach * (Math.cos(angle) - 1)]));
      playing.request = requestAnimationFrame(step);
    };
    playing = { request: requestAnimationFrame(step) };
    place();
  }

  function saveStill() {
    painter.draw();
    const link = document.createElement("a");
    link.href = canvas.toDataURL("image/png");
    link.download = `${data.name}_${state.left}_${state.right}.png`;
    link.click();
  }

  function fit() {
    const box = canvas.getBoundingClientRect(), dots = Math.min(2, devicePixelRatio || 1);
    [canvas.width, canvas.height] = [box.width, box.height].map((x) => Math.max(1, Math.round(x * dots)));
    changed(false);
  }

  for (const side of SIDES) {
    const select = find(`select.${side}`);
    for (const { key, name } of all) select.add(new Option(name, key));
    select.addEventListener("change", () => take({ [side]: select.value }));
  }
  data.views.forEach(({ name }, i) => find("select.view").add(new Option(name, String(i))));
  find("select.view").addEventListener("change", ({ target }) => {
    const { view, light } = start(data.views[Number(target.value)]);
    take({ view, light: { ...light, radius: state.light.radius } });
  });
  find("select.look").addEventListener("change", ({ target }) => take({ look: target.value }));
  find("select.detail").addEventListener("change", ({ target }) => { detail = target.value; changed(); });
  find(".size").addEventListener("input", ({ target }) => (
    take({ light: { ...state.light, radius: data.radius * target.value / 1000 } })));
  find(".turn").addEventListener("input", ({ target }) => (
    take({ move: [...state.move.slice(0, 2), target.value * Math.PI / 180] })));
  find(".play").addEventListener("click", play);
  find(".still").addEventListener("click", saveStill);
  canvas.addEventListener("keydown", (event) => {
    const { key, ctrlKey, metaKey } = event;
    if (ctrlKey || metaKey || !(key in WALK)) return;
    const [right, , forward] = cameraAxes(state.view), [across, ahead] = WALK[key];
    const way = plus(right.map((x) => 0.15 * across * x), unit([forward[0], 0, forward[2]]), 0.15 * ahead);
    take({ view: { ...state.view, eye: plus(state.view.eye, way), target: plus(state.view.target, way) } });
  });
  dragDivider(find(".over"), stage, (divider) => {
    state.divider = divider ?? state.divider;
    place();
    painter.draw();
    touched = true;
    clearTimeout(moved);
    moved = setTimeout(() => writeAddress(stateText(state)), 250);
  }, () => state.divider);
  new ResizeObserver(() => fit()).observe(canvas);
  canvas.addEventListener("webglcontextlost", () => fail(root, new Unavailable(
    "The graphics driver has stopped this page's drawing. Load it anew.")));
  const open = (text) => take(pick(stateOf(text, Object.keys(methods), data.radius)));
  addEventListener("hashchange", () => open(location.hash.slice(1)));
  addEventListener("message", ({ data: given }) => {
    if (typeof given?.open === "string") open(given.open);
  });

  orbit.set(state.view);
  root.classList.add("ready");
  fit();
  if (window.parent !== window) writeAddress(""); // the page may have a state for it

  // For tests and scripts: a method's answers, rows from the top, (height · width) numbers in [0, 1].
  function answers(key, asked) {
    painter.stop();
    const steps = methods[key].answer(renderer, { truth: 64, move: [0, 0, 0], resolution: data.resolution, ...asked,
      view: { up: [0, 1, 0], ...asked.view } });
    let step = steps.next();
    while (!step.done) step = steps.next();
    const { texture, channel } = step.value, numbers_ = renderer.read(texture, asked.size);
    return Array.from({ length: numbers_.length / 4 }, (_, i) => numbers_[4 * i + channel]);
  }
  function channels(asked) {
    painter.stop();
    const whole = { move: [0, 0, 0], resolution: data.resolution, ...asked, view: { up: [0, 1, 0], ...asked.view } };
    const textures = { ...renderer.surfaces(whole), ...renderer.buffers(whole) };
    const names = ["points", "normals", "faces", "lengths", "visibilities", "pcf"];
    return Object.fromEntries(names.map((name) => [name, Array.from(renderer.read(textures[name], asked.size))]));
  }
  const planes = (key, { size }) => methods[key].planes(renderer, size); // of its last answers
  return { methods: Object.keys(methods), state, answers, channels, planes, redraw: () => painter.draw() };
}

const root = document.getElementById("viewer");
startSoftViewer(root, JSON.parse(document.getElementById("data").textContent)).then(
  (viewer) => { window.viewer = viewer; }, (error) => fail(root, error));

// The viewer: two methods of the same frame on both sides of a divider, live.

const MOVING_MS = 40, RESTING_MS = 700; // what a frame may take: at most so many pixels are asked
const SCALES = [1, 1 / 2, 1 / 4, 1 / 8, 1 / 16]; // pixels of an answer by those of the canvas
const DAY_SECONDS = 12;

async function startViewer(root, data) {
  const find = (selector) => root.querySelector(selector), canvas = find("canvas");
  const mesh = await unpackMesh(data.mesh), methods = await allMethods(data.networks);
  const byKey = Object.fromEntries(methods.map((method) => [method.key, method]));
  const keys = Object.keys(byKey);
  const renderer = new Renderer(canvas, data.shaders, data.constants, mesh, data.scene);
  const state = {
    left: data.networks[0]?.key ?? "map_1024", right: "reference", divider: 50, errors: false,
    view: data.views[0], light: data.views[0].light,
  };
  const cost = new Map(); // by method: milliseconds a pixel, once it is measured
  let view = state.view, asked = 0, moving = false, rest = 0, playing = null, told = false;

  const orbit = new Orbit(canvas, data.scene, () => {
    state.view = orbit.view;
    find("select.view").selectedIndex = -1;
    dome.turn(state.view);
    changed();
  });
  const dome = new Dome(find(".dome"), { up: data.scene.up, domain: data.scene.light }, () => {
    if (playing) play();
    state.light = dome.light;
    changed();
  });

  // Something moved; a quarter of a second after the last the frame is drawn as finely as there is
  // time for. A page's address tells what its reader did here, and not that its window was resized.
  function changed(byReader = true) {
    moving = true;
    root.dataset.moving = "true";
    told ||= byReader;
    asked ||= requestAnimationFrame(() => guarded(draw));
    clearTimeout(rest);
    rest = setTimeout(() => { moving = false; guarded(settle); }, 250);
  }

  function guarded(step) {
    try {
      step();
    } catch (error) {
      fail(root, error);
    }
  }

  // Milliseconds of a frame's pixel; infinite as long as nobody knows how long a method takes.
  function pixelCost() {
    const share = state.divider / 100, of = (key) => cost.get(key) ?? Infinity;
    return (share > 0 && of(state.left) * share) + (share < 1 && of(state.right) * (1 - share))
      + (state.errors && of(reference.key));
  }

  // A method's answers, and the milliseconds that they took, with those of a map for this light.
  function timed(method, name, size, from = 0, to = size[0]) {
    renderer.look(view, ...size);
    const { uniforms } = renderer.prepare(method);
    renderer.finish();
    const start = performance.now();
    uniforms(state.light);
    renderer.finish();
    const begun = performance.now();
    const answer = renderer.answer(method, name, view, state.light, ...size, from, to);
    renderer.finish();
    const end = performance.now();
    if (to > from) cost.set(method.key, (end - begun) / ((to - from) * size[1]));
    return [answer, end - start];
  }

  // How many pixels there is time for; few if that is not known.
  function scaleFor(milliseconds) {
    const whole = pixelCost() * canvas.width * canvas.height;
    return SCALES.find((scale) => scale ** 2 * whole <= milliseconds) ?? SCALES.at(-1);
  }

  // Draws, and gives the scale that it was drawn at and the size.
  function frame(milliseconds) {
    const box = canvas.getBoundingClientRect(), dots = Math.min(2, devicePixelRatio || 1);
    const shown = [box.width, box.height].map((x) => Math.max(1, Math.round(x * dots)));
    if (canvas.width !== shown[0]) canvas.width = shown[0];
    if (canvas.height !== shown[1]) canvas.height = shown[1];
    const scale = scaleFor(milliseconds);
    const size = shown.map((x) => Math.max(1, Math.round(x * scale)));
    const divider = Math.round(size[0] * state.divider / 100), { light, errors } = state;
    view = wideEnough(state.view, size[0] / size[1]);
    const [left, leftTook] = timed(byKey[state.left], "left", size, 0, divider);
    const [right, rightTook] = timed(byKey[state.right], "right", size, divider);
    const [truth, truthTook] = errors ? timed(reference, "reference", size) : [right, 0];
    renderer.show({ left, right, reference: truth, light, divider, errors });
    const took = leftTook + rightTook + truthTook;
    find(".rate").textContent =
      `${size[0]} × ${size[1]}: ${took.toFixed(1)} ms, ${rateOf(took)} frames a second`;
    return [scale, size];
  }

  // Draws as finely as there is time for: what few pixels cost says too much of what many will.
  function restingFrame() {
    let [scale, size] = frame(RESTING_MS);
    for (let tries = 0; tries < SCALES.length && scaleFor(RESTING_MS) > scale; tries++) {
      [scale, size] = frame(RESTING_MS);
    }
    return size;
  }

  function draw() {
    asked = 0;
    frame(moving || playing ? MOVING_MS : RESTING_MS);
  }

  // At rest: the whole frame by both methods, how far each is from the reference, and the address.
  function settle() {
    if (playing) return;
    const size = restingFrame(), [, truthTook] = timed(reference, "reference", size);
    const truth = renderer.read("reference");
    for (const side of ["left", "right"]) {
      const method = byKey[state[side]];
      renderer.dropMaps();
      const took = method === reference ? truthTook : timed(method, "whole", size)[1];
      const shares = method === reference ? null : wrongShares(renderer.read("whole"), truth);
      find(`.facts.${side}`).textContent = factsOf(method, took, shares);
    }
    if (told || window.parent === window) writeAddress(stateText(state));
    root.dataset.moving = "false"; // tests wait for it
  }

  function place() {
    find(".over").style.left = `${state.divider}%`;
    find(".over").setAttribute("aria-valuenow", state.divider.toFixed(0));
    for (const side of ["left", "right"]) find(`select.${side}`).value = state[side];
    find(".errors").setAttribute("aria-pressed", String(state.errors));
    find(".legend").hidden = !state.errors;
    find(".play").setAttribute("aria-pressed", String(Boolean(playing)));
  }

  function take(given, byReader = true) {
    Object.assign(state, given);
    if (given.light) dome.set(given.light);
    state.light = dome.light;
    if (given.view) {
      orbit.set(given.view);
      state.view = orbit.view;
      find("select.view").selectedIndex = data.views.indexOf(given.view);
      dome.turn(state.view);
    }
    if (playing && given.light) play();
    place();
    changed(byReader);
  }

  // A day of light from where it stands, or no longer.
  function play() {
    if (playing) {
      cancelAnimationFrame(playing);
      playing = null;
    } else {
      const start = performance.now() - 1000 * DAY_SECONDS * dome.time();
      const step = (now) => {
        dome.set(dome.atTime((now - start) / 1000 / DAY_SECONDS % 1));
        state.light = dome.light;
        playing = requestAnimationFrame(step);
        guarded(draw);
      };
      playing = requestAnimationFrame(step);
    }
    place();
    changed();
  }

  function saveStill() {
    restingFrame();
    const link = document.createElement("a");
    link.href = canvas.toDataURL("image/png");
    link.download = `${data.name}_${state.left}_${state.right}.png`;
    link.click();
  }

  for (const side of ["left", "right"]) {
    const select = find(`select.${side}`);
    for (const { key, name } of methods) select.add(new Option(name, key));
    select.addEventListener("change", () => take({ [side]: select.value }));
  }
  data.views.forEach(({ name }, i) => find("select.view").add(new Option(name, String(i))));
  find("select.view").addEventListener("change", (event) => {
    const view = data.views[Number(event.target.value)];
    take({ view, light: view.light });
  });
  const toggle = () => take({ errors: !state.errors });
  find(".errors").addEventListener("click", toggle);
  find(".play").addEventListener("click", play);
  find(".still").addEventListener("click", saveStill);
  find(".stage").addEventListener("keydown", ({ key, ctrlKey, metaKey, target }) => {
    if (ctrlKey || metaKey || target.tagName === "SELECT") return;
    ({ e: toggle, p: play, s: saveStill })[key]?.();
  });
  dragDivider(find(".over"), find(".stage"), (divider) => {
    state.divider = divider ?? state.divider;
    place();
    changed();
  }, () => state.divider);
  new ResizeObserver(() => changed(false)).observe(canvas);
  canvas.addEventListener("webglcontextlost", () => fail(root, new Unavailable(
    "The graphics driver has stopped this page's drawing. Load it anew.")));
  const open = (text) => take(stateOf(text, keys));
  addEventListener("hashchange", () => open(location.hash.slice(1)));
  addEventListener("message", ({ data: given }) => {
    if (typeof given?.open === "string") open(given.open);
  });

  dome.turn(state.view);
  take({ ...state, ...stateOf(location.hash.slice(1), keys) }, false);
  root.classList.add("ready");
  if (window.parent !== window) writeAddress(""); // the page may have a state for it

  // For tests and scripts: a method's answers at each pixel, rows from the top, (height · width)
  // numbers from 0, dark, to 255, lit; −1 where there is no surface.
  return {
    methods: keys,
    answers(key, view, light, width, height) {
      renderer.answer(byKey[key], "asked", { up: data.scene.up, ...view }, light, width, height);
      const pixels = renderer.read("asked");
      return Array.from({ length: width * height }, (_, i) => pixels[4 * i + 1] ? pixels[4 * i] : -1);
    },
  };
}

// A view whose field reaches as far to the sides as that of a frame of 3:2, in a narrow one too.
function wideEnough(view, aspect) {
  const half = Math.tan(view.fov * Math.PI / 360) * Math.max(1, 1.5 / aspect);
  return { ...view, fov: Math.atan(half) * 360 / Math.PI };
}

// Frames a second; a clock may be coarse, and no more than 1,000 are told.
function rateOf(milliseconds) {
  return milliseconds > 100 ? (1000 / milliseconds).toFixed(1) : Math.round(1000 / Math.max(milliseconds, 1));
}

// shares: null for the reference.
function factsOf({ stored, resident }, milliseconds, shares) {
  const percent = (share) => `${(100 * share).toFixed(2)} %`, mebi = 1 << 20;
  const bytes = (count) => count < mebi / 10 ? `${(count / 1024).toFixed(0)} KiB` : `${(count / mebi).toFixed(2)} MiB`;
  const facts = [`${milliseconds.toFixed(1)} ms a frame, ${rateOf(milliseconds)} a second`];
  if (resident) facts.unshift(`${bytes(resident)} in memory`);
  if (stored !== undefined) facts.unshift(`${bytes(stored)} stored`);
  if (shares) {
    facts.push(`false shadow ${percent(shares.falseShadow)}`,
      `light leak ${percent(shares.lightLeak)} of the points seen`);
  }
  return facts.join(" · ");
}

const root = document.getElementById("viewer");
startViewer(root, JSON.parse(document.getElementById("data").textContent)).then(
  (viewer) => { window.viewer = viewer; }, (error) => fail(root, error));

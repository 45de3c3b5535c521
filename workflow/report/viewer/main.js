// The viewer: two methods of the same frame on both sides of a divider, live.

const MOVING_MS = 40, RESTING_MS = 700; // what a frame may take: at most so many pixels are asked
const FINEST = 1, COARSEST = 1 / 16; // pixels of an answer by those of the canvas, along an axis
const DAY_SECONDS = 12;

async function startViewer(root, data) {
  const find = (selector) => root.querySelector(selector), canvas = find("canvas");
  const mesh = await unpackMesh(data.mesh), methods = await allMethods(data.networks);
  const byKey = Object.fromEntries(methods.map((method) => [method.key, method]));
  const renderer = new Renderer(canvas, data.shaders, data.constants, mesh, data.scene);
  const state = {
    left: data.networks[0]?.key ?? "map_1024", right: "reference", divider: 50, errors: false,
    view: data.views[0], light: data.views[0].light,
  };
  const cost = new Map(); // by method: milliseconds a pixel, once it is measured
  let view = state.view, asked = 0, moving = false, rest = 0, playing = null;

  const orbit = new Orbit(canvas, data.scene, (still) => {
    state.view = orbit.view;
    dome.turn(state.view);
    changed(still);
  });
  const dome = new Dome(find(".dome"), { up: data.scene.up, domain: data.scene.light }, (still) => {
    state.light = dome.light;
    changed(still);
  });

  // Something moved, or came to rest: then the frame is drawn as finely as there is time for.
  function changed(still) {
    moving = still;
    asked ||= requestAnimationFrame(draw);
    clearTimeout(rest);
    rest = setTimeout(() => { moving = false; settle(); }, 250);
  }

  // Milliseconds of a frame's pixel; infinite as long as nobody knows how long a method takes.
  function pixelCost() {
    const share = state.divider / 100, of = (side) => cost.get(state[side]) ?? Infinity;
    return (share > 0 && of("left") * share) + (share < 1 && of("right") * (1 - share));
  }

  // A method's answers, and the milliseconds that they took.
  function timed(side, name, size, from, to) {
    const method = byKey[state[side]], { light } = state;
    if (!renderer.made.has(method.key)) renderer.answer(method, name, view, light, ...size, 0, 1);
    const start = performance.now();
    const answer = renderer.answer(method, name, view, light, ...size, from, to);
    renderer.finish();
    const took = performance.now() - start;
    if (to > from) cost.set(method.key, took / ((to - from) * size[1]));
    return [answer, took];
  }

  // Asks as many pixels as there is time for; few if that is not known, and then once more.
  function frame(milliseconds, again = true) {
    const box = canvas.getBoundingClientRect(), dots = Math.min(2, devicePixelRatio || 1);
    canvas.width = Math.max(1, Math.round(box.width * dots));
    canvas.height = Math.max(1, Math.round(box.height * dots));
    const each = pixelCost(), most = Math.sqrt(milliseconds / (each * canvas.width * canvas.height));
    const scale = clamped(most, COARSEST, FINEST);
    const size = [canvas.width, canvas.height].map((x) => Math.max(1, Math.round(x * scale)));
    const divider = Math.round(size[0] * state.divider / 100), { light } = state;
    view = wideEnough(state.view, size[0] / size[1]);
    const [left, leftTook] = timed("left", "left", size, 0, divider);
    const [right, rightTook] = timed("right", "right", size, divider, size[0]);
    const truth = state.errors ? renderer.answer(reference, "reference", view, light, ...size) : right;
    renderer.show({ left, right, reference: truth, light, divider, errors: state.errors });
    const took = leftTook + rightTook;
    find(".rate").textContent =
      `${size[0]} × ${size[1]}: ${took.toFixed(1)} ms, ${(1000 / took).toPrecision(2)} frames a second`;
    return again && each === Infinity ? frame(milliseconds, false) : size;
  }

  function draw() {
    asked = 0;
    frame(moving || playing ? MOVING_MS : RESTING_MS);
  }

  // At rest: the whole frame by both methods, how far each is from the reference, and the address.
  function settle() {
    if (playing) return;
    const size = frame(RESTING_MS), { light } = state;
    renderer.answer(reference, "reference", view, light, ...size);
    const truth = renderer.read("reference");
    for (const side of ["left", "right"]) {
      const [, took] = timed(side, "whole", size, 0, size[0]);
      const shares = wrongShares(renderer.read("whole"), truth), method = byKey[state[side]];
      find(`.facts.${side}`).textContent = method === reference ? "" : factsOf(method, took, shares);
    }
    writeAddress(stateText(state));
    root.dataset.settled = String(Number(root.dataset.settled ?? 0) + 1);
  }

  function place() {
    find(".over").style.left = `${state.divider}%`;
    find(".over").setAttribute("aria-valuenow", state.divider.toFixed(0));
    for (const side of ["left", "right"]) find(`select.${side}`).value = state[side];
    find(".errors").setAttribute("aria-pressed", String(state.errors));
    find(".legend").hidden = !state.errors;
    find(".play").setAttribute("aria-pressed", String(Boolean(playing)));
  }

  function take(given) {
    Object.assign(state, given);
    if (given.light) dome.set(given.light);
    state.light = dome.light;
    if (given.view) orbit.set(given.view);
    place();
    changed(false);
  }

  function play() {
    if (playing) {
      cancelAnimationFrame(playing);
      playing = null;
    } else {
      const start = performance.now();
      const step = (now) => {
        dome.set(dome.atTime((now - start) / 1000 / DAY_SECONDS % 1));
        state.light = dome.light;
        playing = requestAnimationFrame(step);
        draw();
      };
      playing = requestAnimationFrame(step);
    }
    place();
    changed(false);
  }

  function saveStill() {
    frame(RESTING_MS);
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
    changed(true);
  }, () => state.divider);
  new ResizeObserver(() => changed(false)).observe(canvas);
  addEventListener("message", ({ data: told }) => {
    if (typeof told?.open === "string") take(stateOf(told.open, Object.keys(byKey)));
  });

  dome.turn(state.view);
  take({ ...state, ...stateOf(location.hash.slice(1), Object.keys(byKey)) });
  root.classList.add("ready");

  // For tests and scripts: a method's answers at each pixel, rows from the top; 0 to 255, and 255
  // for what is not asked, is −1: (height · width) numbers.
  return {
    methods: Object.keys(byKey),
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

function factsOf({ stored, resident }, milliseconds, { falseShadow, lightLeak }) {
  const percent = (share) => `${(100 * share).toFixed(2)} %`, mebi = 1 << 20;
  const bytes = (count) => count < mebi / 10 ? `${(count / 1024).toFixed(0)} KiB` : `${(count / mebi).toFixed(2)} MiB`;
  const kept = stored === undefined ? [] : [`${bytes(stored)} stored`];
  if (resident) kept.push(`${bytes(resident)} in memory`);
  return [...kept, `${milliseconds.toFixed(1)} ms`, `false shadow ${percent(falseShadow)}`,
    `light leak ${percent(lightLeak)} of the pixels`].join(" · ");
}

// moved: told where the divider is, in per cent of the stage's width.
function dragDivider(handle, stage, moved, at) {
  const place = (event) => {
    const box = stage.getBoundingClientRect();
    moved(clamped(100 * (event.clientX - box.left) / box.width, 0, 100));
  };
  let held = false;
  handle.addEventListener("pointerdown", (event) => {
    handle.setPointerCapture(event.pointerId);
    held = true;
  });
  handle.addEventListener("pointermove", (event) => { if (held) place(event); });
  for (const end of ["pointerup", "pointercancel"]) handle.addEventListener(end, () => { held = false; });
  handle.addEventListener("keydown", (event) => {
    const steps = { ArrowLeft: -2, ArrowRight: 2, PageDown: -10, PageUp: 10, Home: -100, End: 100 };
    if (!(event.key in steps)) return;
    event.preventDefault();
    moved(clamped(at() + steps[event.key], 0, 100));
  });
}

const root = document.getElementById("viewer");
startViewer(root, JSON.parse(document.getElementById("data").textContent)).then((viewer) => {
  window.viewer = viewer;
}, (error) => {
  root.classList.add("failed");
  root.querySelector(".reason").textContent = error instanceof Unavailable
    ? `${error.message} This is a still of what it would show.` : `The viewer cannot start: ${error.message}`;
});

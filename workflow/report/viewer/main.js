// The viewer: two methods of the same frame on both sides of a divider, live.

const MOVING_MS = 40; // what a frame may take while something moves
const MOVING_RAYS = 4; // of a pixel then, over a sun that has a size
const SCALES = [1, 1 / 2, 1 / 4, 1 / 8, 1 / 16]; // pixels of an answer by those of the canvas, then
const COARSE = { left: "left", right: "right", reference: "reference" };
const DAY_SECONDS = 12;

async function startViewer(root, data) {
  const find = (selector) => root.querySelector(selector), canvas = find("canvas");
  const mesh = await unpackMesh(data.mesh), methods = await allMethods(data.networks);
  const byKey = Object.fromEntries(methods.map((method) => [method.key, method]));
  const renderer = new Renderer(canvas, data.shaders, data.constants, data.scene);
  renderer.setMesh(mesh, data.scene.ground);
  const thesis = data.networks.find(({ encoding }) => encoding === "frequency");
  const state = {
    left: thesis?.key ?? "map_256", right: "reference", divider: 50, errors: false, sun: 0,
    view: data.views[0], light: data.views[0].light,
  };
  const costs = new Map(); // by method's key: milliseconds of a pixel's ray, once it is measured
  let pending = 0, moving = false, pause = 0, playing = null, byHand = false;
  let resting = null, steps = null; // at rest: the frame, and what is left to do of its refinement
  let whole = ""; // what the answers at rest are of, once all of them are there
  let still = false; // wanted as soon as the picture is refined
  let own = null; // a reader's mesh, in place of the scene's
  const keys = () => methods.filter((method) => !own || !method.ofShipped).map(({ key }) => key);

  const orbit = new Orbit(canvas, data.scene, () => {
    state.view = orbit.view;
    find("select.view").selectedIndex = -1;
    dome.turn(state.view);
    changed();
  });
  const dome = new Dome(find(".dome"), { up: data.scene.up, domain: data.scene.light }, () => {
    if (playing) play();
    find(".hint").hidden = true;
    state.light = dome.light;
    changed();
  });

  // Something moved; a quarter of a second after the last the picture is refined. A page's address
  // follows what its reader did here, and not a window of another size.
  function changed(byReader = true) {
    moving = true;
    steps = null;
    root.dataset.moving = "true";
    root.dataset.refined = "false";
    byHand ||= byReader;
    next();
    clearTimeout(pause);
    pause = setTimeout(() => {
      moving = false;
      if (!playing) guarded(rest);
    }, 250);
  }

  function next() {
    pending ||= requestAnimationFrame(() => {
      pending = 0;
      guarded(moving || playing ? drawMoving : refine);
    });
  }

  function guarded(step) {
    if (root.classList.contains("failed")) return;
    try {
      step();
    } catch (error) {
      fail(root, error);
    }
  }

  // The methods of the two sides, each as it is under this sun.
  function sides() {
    const under = (key) => state.sun > 0 && byKey[key].soft || byKey[key];
    return { left: under(state.left), right: under(state.right) };
  }

  // View, sun and the canvas's size, which follows the page's.
  function frameNow() {
    const box = canvas.getBoundingClientRect(), dots = Math.min(2, devicePixelRatio || 1);
    const size = [box.width, box.height].map((x) => Math.max(1, Math.round(x * dots)));
    if (canvas.width !== size[0]) canvas.width = size[0];
    if (canvas.height !== size[1]) canvas.height = size[1];
    const sun = { light: state.light, slope: Math.tan(state.sun * Math.PI / 360) };
    return { view: wideEnough(state.view, size[0] / size[1]), size, sun };
  }

  const picture = () => ({ divider: Math.round(canvas.width * state.divider / 100), errors: state.errors });
  const answersOf = (frame) => JSON.stringify([frame, state.left, state.right]);

  // As finely as there is time for; whole answers at rest stay as long as only the divider moves.
  function drawMoving() {
    const frame = frameNow(), { left, right } = sides(), share = state.divider / 100;
    if (whole === answersOf(frame)) return renderer.show(namesAtRest(sides()), frame, picture());
    const { sun } = frame, parts = [[left, "left", 0, share], [right, "right", share, 1]];
    if (state.errors) parts.push([reference, "reference", 0, 1]);
    const pixel = parts.reduce((sum, [method, , from, to]) => to > from
      ? sum + (to - from) * raysOf(method, sun, MOVING_RAYS) * (costs.get(method.key) ?? Infinity) : sum, 0);
    const pixels = frame.size[0] * frame.size[1];
    const scale = SCALES.find((scale) => scale ** 2 * pixels * pixel <= MOVING_MS) ?? SCALES.at(-1);
    const coarse = { ...frame, size: frame.size.map((x) => Math.max(1, Math.round(x * scale))) };
    renderer.look(coarse.view, coarse.size);
    renderer.finish();
    let took = 0;
    for (const [method, name, from, to] of parts) {
      // A column more on either side, since the picture interpolates.
      const columns = { from: Math.floor(from * coarse.size[0]) - 1, to: Math.ceil(to * coarse.size[0]) + 1 };
      took += timed(method, name, coarse, columns, to > from);
    }
    renderer.show(COARSE, frame, picture());
    find(".rate").textContent =
      `${coarse.size.join(" × ")}: ${took.toFixed(1)} ms, ${rateOf(took)} frames a second`;
  }

  // Milliseconds of a method's answers, with those of a map for this light.
  function timed(method, name, frame, { from, to }, counts) {
    const { size, sun } = frame, rays = raysOf(method, sun, MOVING_RAYS);
    const columns = { from: Math.max(0, from), to: Math.min(to, size[0]) };
    const { uniforms } = renderer.prepare(method);
    renderer.finish();
    const start = performance.now();
    uniforms(sun.light);
    renderer.finish();
    const begun = performance.now();
    renderer.answer(method, name, frame, { ...columns, rays });
    renderer.finish();
    const end = performance.now();
    if (counts) costs.set(method.key, (end - begun) / ((columns.to - columns.from) * size[1] * rays));
    return end - start;
  }

  function rest() {
    root.dataset.moving = "false"; // tests wait for it
    if (!own && (byHand || window.parent === window)) writeAddress(stateText(state));
    resting = frameNow();
    if (whole === answersOf(resting)) return refined();
    showFacts({});
    steps = refinement(renderer, resting, sides(), picture(), costs, () => { if (still) save(); });
    next();
  }

  // A step of the refinement.
  function refine() {
    if (!steps) return;
    const { done, value } = steps.next();
    if (!done) {
      find(".rate").textContent = value;
      next();
      return;
    }
    steps = null;
    whole = answersOf(resting);
    showFacts(value);
    refined();
  }

  function refined() {
    find(".rate").textContent = `${canvas.width} × ${canvas.height}`;
    root.dataset.refined = "true"; // tests wait for it
    if (still) save();
  }

  // results: of the refinement, by side, as soon as they are there.
  function showFacts(results) {
    for (const [side, method] of Object.entries(sides())) {
      find(`.facts.${side}`).textContent = factsOf(method, resting.sun, results[side]);
    }
  }

  function place() {
    find(".over").style.left = `${state.divider}%`;
    find(".over").setAttribute("aria-valuenow", state.divider.toFixed(0));
    for (const side of ["left", "right"]) find(`select.${side}`).value = state[side];
    find("input.sun").value = state.sun;
    find("output.sun").textContent = `${state.sun.toFixed(1)}°`;
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
        guarded(drawMoving);
      };
      playing = requestAnimationFrame(step);
      find(".hint").hidden = true;
    }
    place();
    changed();
  }

  // A still is saved once the picture is refined.
  function saveStill() {
    if (playing) play();
    still = true;
    if (root.dataset.refined === "true") save();
  }

  function save() {
    still = false;
    const link = document.createElement("a");
    link.href = canvas.toDataURL("image/png");
    link.download = `${own?.name ?? data.name}_${state.left}_${state.right}.png`;
    link.click();
  }

  // A mesh of the reader's, or a word why not.
  async function openMesh(file) {
    find(".notice").textContent = `Reading ${file.name} …`;
    try {
      const read = await readMesh(file), small = reduced(read);
      own = { name: file.name, small, count: read.faces.length / 3 };
    } catch (error) {
      if (!(error instanceof Unreadable)) throw error;
      find(".notice").textContent = error.message;
      return;
    }
    guarded(showOwn);
  }

  function showOwn() {
    const { name, small, count } = own, shown = small.faces.length / 3;
    const placed = upright(small, find("select.up").selectedIndex, data.scene.up);
    orbit.ground = data.scene.ground === null ? null : placed.ground;
    renderer.setMesh(placed, orbit.ground);
    whole = "";
    find("h1").textContent = `Shadows of ${name}`;
    find(".notice").textContent = `${name}: ${count.toLocaleString("en")} triangles`
      + (shown < count ? `, merged to ${shown.toLocaleString("en")} so that it moves.` : ".")
      + " Fields and networks are of the first mesh alone: they are off until this page is loaded anew.";
    find(".upright").hidden = false;
    for (const option of root.querySelectorAll("select.left option, select.right option")) {
      option.disabled = byKey[option.value].ofShipped;
    }
    for (const option of find("select.view")) option.disabled = option.index > 0;
    const allowed = ["left", "right"].filter((side) => byKey[state[side]].ofShipped);
    take({ ...Object.fromEntries(allowed.map((side) => [side, "map_256"])), view: data.views[0] });
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
  find("input.sun").max = MOST_SUN;
  find("input.sun").addEventListener("input", (event) => take({ sun: Number(event.target.value) }));
  const toggle = () => take({ errors: !state.errors });
  find(".errors").addEventListener("click", toggle);
  find(".play").addEventListener("click", play);
  find(".still").addEventListener("click", saveStill);
  find(".open").addEventListener("click", () => find(".file").click());
  find(".file").addEventListener("change", ({ target }) => { if (target.files[0]) openMesh(target.files[0]); });
  find("select.up").addEventListener("change", () => guarded(showOwn));
  addEventListener("dragover", (event) => event.preventDefault());
  addEventListener("drop", (event) => {
    event.preventDefault();
    if (event.dataTransfer.files[0]) openMesh(event.dataTransfer.files[0]);
  });
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
  const open = (text) => take(stateOf(text, keys()));
  addEventListener("hashchange", () => open(location.hash.slice(1)));
  addEventListener("message", ({ data: given }) => {
    if (typeof given?.open === "string") open(given.open);
  });

  dome.turn(state.view);
  take({ ...state, ...stateOf(location.hash.slice(1), keys()) }, false);
  root.classList.add("ready");
  if (window.parent !== window) writeAddress(""); // the page may have a state for it

  // For tests and scripts: a method's answers at each pixel, rows from the top, (height · width)
  // numbers from 0, dark, to 1, lit; −1 where there is no surface. sun: degrees across.
  return {
    methods: methods.map(({ key }) => key),
    answers(key, view, light, width, height, sun = 0) {
      const frame = {
        view: { up: data.scene.up, ...view }, size: [width, height],
        sun: { light, slope: Math.tan(sun * Math.PI / 360) },
      };
      const method = sun > 0 && byKey[key].soft || byKey[key];
      renderer.answer(method, "for tests", frame, { rays: raysOf(method, frame.sun, RAYS) });
      const rows = renderer.read("for tests");
      return Array.from({ length: height }, (_, y) =>
        Array.from(rows.subarray((height - 1 - y) * width, (height - y) * width))).flat();
    },
  };
}

// A view whose field reaches as far to the sides as that of a frame of 3:2, in a narrow one too.
function wideEnough(view, aspect) {
  const half = Math.tan(view.fov * Math.PI / 360) * Math.max(1, 1.5 / aspect);
  return { ...view, fov: Math.atan(half) * 360 / Math.PI };
}

const root = document.getElementById("viewer");
startViewer(root, JSON.parse(document.getElementById("data").textContent)).then(
  (viewer) => { window.viewer = viewer; }, (error) => fail(root, error));

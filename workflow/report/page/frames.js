"use strict";

// Frames side by side: two methods under a divider. `paintHard` and `softPainter` put a method's
// picture into a layer of the stage.
const LARGEST_ZOOM = 16;
const PICTURES = JSON.parse(document.getElementById("pictures").textContent);
const withPictures = (key, value) => value?.picture === undefined ? value : PICTURES[value.picture];

for (const article of document.querySelectorAll("article.compare")) {
  const data = JSON.parse(article.querySelector("script").textContent, withPictures);
  const find = (selector) => article.querySelector(selector);
  const stage = find(".stage"), divider = find(".divider"), over = find(".over");
  const view = find(".view"), left = find(".left"), right = find(".right"), shown = find(".shown");
  const lights = [...article.querySelectorAll("button[data-light]")];
  const names = Object.fromEntries(data.methods.map((method) => [method.key, method.name]));
  const paint = data.soft ? softPainter(data.errors) : paintHard;
  // position: of the divider in per cent; x, y: of the picture's corner in stage widths.
  const state = { position: 50, zoom: 1, x: 0, y: 0, light: lights.length - 1 };

  data.views.forEach((item, i) => view.add(new Option(item.caption, String(i))));
  for (const method of data.methods) {
    left.add(new Option(method.name, method.key));
    right.add(new Option(method.name, method.key));
  }
  left.value = data.left;
  right.value = data.right;

  function show() {
    const item = data.views[Number(view.value)];
    const pictures = data.soft ? item.lights[state.light] : item.pictures;
    const light = data.soft ? `, ${data.lights[state.light].name}` : "";
    stage.style.aspectRatio = `${item.width} / ${item.height}`;
    for (const [layer, key, name] of [
      [over, left.value, find(".name-left")],
      [find(".under"), right.value, find(".name-right")],
    ]) {
      const { scores } = pictures[key];
      const alt = `${names[key]}, ${shown.selectedOptions[0].text}, ${item.caption}${light}`;
      paint(layer, { item, pictures, key, shown: shown.value, alt });
      name.textContent = scores ? `${names[key]}: ${scores}` : names[key];
    }
    for (const scale of article.querySelectorAll(".scale")) {
      scale.hidden = scale.dataset.of !== shown.value;
    }
    lights.forEach((button, i) => button.setAttribute("aria-pressed", String(i === state.light)));
  }

  function place() {
    const height = stage.clientHeight / stage.clientWidth || 2 / 3;
    state.x = Math.min(0, Math.max(1 - state.zoom, state.x));
    state.y = Math.min(0, Math.max((1 - state.zoom) * height, state.y));
    const width = stage.clientWidth;
    for (const image of article.querySelectorAll(".layer > *")) {
      image.style.transform =
        `translate(${state.x * width}px, ${state.y * width}px) scale(${state.zoom})`;
    }
    stage.classList.toggle("zoomed", state.zoom > 1);
    find("output").textContent = `${state.zoom}×`;
    over.style.clipPath = `inset(0 ${100 - state.position}% 0 0)`;
    divider.style.left = `${state.position}%`;
    divider.setAttribute("aria-valuenow", String(Math.round(state.position)));
  }

  function moveDivider(position) {
    state.position = Math.min(100, Math.max(0, position));
    place();
  }

  // Zoom about a point of the stage, in stage widths.
  function zoomBy(factor, x, y) {
    const zoom = Math.min(LARGEST_ZOOM, Math.max(1, state.zoom * factor));
    state.x = x - (x - state.x) * zoom / state.zoom;
    state.y = y - (y - state.y) * zoom / state.zoom;
    state.zoom = zoom;
    place();
  }
  const zoomMiddle = (factor) =>
    zoomBy(factor, 0.5, stage.clientHeight / stage.clientWidth / 2);
  const pointOf = (event) => {
    const box = stage.getBoundingClientRect();
    return [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.width];
  };

  for (const select of [view, left, right, shown]) select.addEventListener("change", show);
  lights.forEach((button, i) => button.addEventListener("click", () => {
    state.light = i;
    show();
  }));
  find(".in").addEventListener("click", () => zoomMiddle(2));
  find(".out").addEventListener("click", () => zoomMiddle(0.5));
  find(".reset").addEventListener("click", () => {
    Object.assign(state, { position: 50, zoom: 1, x: 0, y: 0 });
    place();
  });
  stage.addEventListener("dblclick", (event) => zoomBy(2, ...pointOf(event)));
  stage.addEventListener("wheel", (event) => {
    if (!event.ctrlKey) return; // without it the page scrolls
    event.preventDefault();
    zoomBy(event.deltaY < 0 ? 2 : 0.5, ...pointOf(event));
  }, { passive: false });

  let drag = null;
  stage.addEventListener("pointerdown", (event) => {
    const onDivider = event.target === divider || state.zoom === 1;
    drag = { onDivider, at: pointOf(event) };
    stage.setPointerCapture(event.pointerId);
  });
  stage.addEventListener("pointermove", (event) => {
    if (!drag) return;
    const at = pointOf(event);
    if (drag.onDivider) {
      drag.moved ||= Math.abs(at[0] - drag.at[0]) > 0.005; // a click is no drag
      if (drag.moved) moveDivider(100 * at[0]);
    } else {
      state.x += at[0] - drag.at[0];
      state.y += at[1] - drag.at[1];
      drag.at = at;
      place();
    }
  });
  for (const end of ["pointerup", "pointercancel"]) {
    stage.addEventListener(end, () => { drag = null; });
  }
  divider.addEventListener("keydown", (event) => {
    const moves = { ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    const steps = { ArrowLeft: -2, ArrowRight: 2, PageDown: -10, PageUp: 10 };
    if (event.shiftKey && event.key in moves) {
      state.x += 0.1 * moves[event.key][0];
      state.y += 0.1 * moves[event.key][1];
      place();
    } else if (event.key in steps) moveDivider(state.position + steps[event.key]);
    else if (event.key === "Home") moveDivider(0);
    else if (event.key === "End") moveDivider(100);
    else if (event.key === "+") zoomMiddle(2);
    else if (event.key === "-") zoomMiddle(0.5);
    else return;
    event.preventDefault();
  });
  addEventListener("resize", place);

  show();
  place();
}

// What a viewer does with the page around it.

// In a page's frame the page's own address holds its state; on its own, the viewer's.
function writeAddress(text) {
  if (window.parent !== window) window.parent.postMessage({ viewer: text }, "*");
  else history.replaceState(null, "", `#${text}`);
}

// Once it cannot go on: a still, and the reason.
function fail(root, error) {
  root.classList.remove("ready");
  root.classList.add("failed");
  root.querySelector(".reason").textContent = error instanceof Unavailable
    ? `${error.message} This is a still of what it would show.` : `The viewer cannot go on: ${error.message}`;
}

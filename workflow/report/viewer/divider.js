// The divider between two pictures, by pointer and keyboard.

// moved: called with the divider's place, in per cent of the stage's width; at: gives it.
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

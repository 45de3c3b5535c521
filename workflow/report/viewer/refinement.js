// The picture at rest, in bands of rows from the top, so that any movement can end it between two:
// what is shown, at full size; more rays over the sun's disc; then the rest of the answers, to
// compare them.

const BAND_MS = 50; // a band takes about so long
const RAYS = 64, RAYS_A_PASS = 4; // of a pixel, over a sun that has a size
const FINE = { left: "left at rest", right: "right at rest", reference: "reference at rest" };

const raysOf = (method, sun, most) => sun.slope > 0 && method.rays ? most : 1;

// The side whose answers are the reference's, if one is.
const truthOf = (sides) => Object.keys(sides).find((side) => sides[side] === reference) ?? "reference";
// Of the answers, as the renderer has them.
const namesAtRest = (sides) => ({ ...FINE, reference: FINE[truthOf(sides)] });

// sides: the methods `left` and `right`; picture: `divider` in pixels, `errors`; costs: by a method's
// key, milliseconds of a pixel's ray, which it keeps up to date. Yields words; `shown` is called once
// all that is shown is there. Gives for each side its milliseconds and, but for the reference, its
// shares of wrong points.
function* refinement(renderer, frame, sides, picture, costs, shown) {
  const { size: [width, height], sun } = frame, { divider, errors } = picture;
  const truth = truthOf(sides), names = namesAtRest(sides), took = { left: 0, right: 0, reference: 0 };
  const left = [0, divider], right = [divider, width], whole = [0, width], none = [0, 0];
  const columns = { left: [left, right], right: [right, left], reference: [none, whole] };
  if (errors) columns[truth] = [whole, none];
  const [shownParts, others] = [0, 1].map((k) => [...new Set(["left", "right", truth])]
    .map((side) => ({ side, method: sides[side] ?? reference, from: columns[side][k][0], to: columns[side][k][1] }))
    .filter(({ from, to }) => to > from));

  function* drawn(given, word) {
    const passes = sun.slope > 0 && given.some(({ method }) => method.rays) ? RAYS / RAYS_A_PASS : 1;
    const row = given.reduce((sum, { method, from, to }) => sum
      + (to - from) * raysOf(method, sun, RAYS_A_PASS) * (costs.get(method.key) ?? Infinity), 0);
    for (const { method } of given) renderer.prepare(method);
    renderer.finish();
    const before = { ...took };
    let rows = clamped(Math.floor(BAND_MS / row), 1, height);
    for (let pass = 0; pass < passes; pass++) {
      for (let top = 0; top < height;) {
        const end = Math.min(height, top + rows), start = performance.now();
        for (const { side, method, from, to } of given) {
          if (pass > 0 && !method.rays) continue;
          const rays = raysOf(method, sun, RAYS_A_PASS), begun = performance.now();
          renderer.answer(method, names[side], frame, { from, to, top, end, first: pass * rays, rays });
          renderer.finish();
          took[side] += performance.now() - begun;
        }
        if (given === shownParts) renderer.show(names, frame, picture, top, end);
        rows = clamped(Math.floor((end - top) * BAND_MS / (performance.now() - start)), 1, 4 * rows);
        top = end;
        yield passes === 1 || pass === 0 && given === shownParts ? `${word}: ${(100 * top / height).toFixed(0)} %`
          : `${word}: ${pass * RAYS_A_PASS} of ${RAYS} rays to the sun`;
      }
    }
    for (const { side, method, from, to } of given) {
      const rays = (to - from) * height * raysOf(method, sun, RAYS);
      costs.set(method.key, (took[side] - before[side]) / rays);
    }
  }

  renderer.dropMaps(); // their time counts
  renderer.look(frame.view, frame.size);
  yield* drawn(shownParts, "Refining");
  shown();
  yield* drawn(others, "Comparing");
  const results = {};
  for (const side of ["left", "right"]) {
    const shares = side === truth ? null : yield* wrongShares(renderer, names[side], names.reference, height);
    results[side] = { milliseconds: took[side], shares };
  }
  return results;
}

// Shares of the points seen that a method calls dark where the reference is lit, and lit where it is
// dark, as metrics/shadow_error.py counts them. By bands too: a frame takes 16 bytes a pixel.
function* wrongShares(renderer, name, truth, height) {
  let dark = 0, lit = 0, seen = 0;
  for (let low = 0; low < height; low += 128) {
    const [answers, exact] = [name, truth].map((each) => renderer.read(each, low, low + 128));
    exact.forEach((visibility, i) => {
      if (visibility < 0) return;
      const wrong = answers[i] - visibility;
      seen++;
      if (wrong < 0) dark -= wrong;
      else lit += wrong;
    });
    yield "Comparing";
  }
  return { falseShadow: dark / Math.max(1, seen), lightLeak: lit / Math.max(1, seen) };
}

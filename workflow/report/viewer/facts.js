// Facts of a method, for below the picture.

// Frames a second; a clock may be coarse, and 1,000 are the most.
function rateOf(milliseconds) {
  return milliseconds > 100 ? (1000 / milliseconds).toFixed(1) : Math.round(1000 / Math.max(milliseconds, 1));
}

// result: the side's of `refinement`, if it is there already.
function factsOf({ stored, resident, rays, underSun }, sun, result) {
  const percent = (share) => share > 0 && share < 5e-5 ? "< 0.01 %" : `${(100 * share).toFixed(2)} %`;
  const mebi = 1 << 20;
  const bytes = (count) => count < mebi / 10 ? `${(count / 1024).toFixed(0)} KiB` : `${(count / mebi).toFixed(2)} MiB`;
  const facts = [];
  if (stored !== undefined) facts.push(`${bytes(stored)} stored`);
  if (resident) facts.push(`${bytes(resident)} in memory`);
  if (sun.slope > 0 && (rays || underSun)) facts.push(underSun ?? `${RAYS} rays over the sun's disc`);
  if (result) facts.push(`${result.milliseconds.toFixed(1)} ms a frame, ${rateOf(result.milliseconds)} a second`);
  if (result?.shares) {
    facts.push(`false shadow ${percent(result.shares.falseShadow)}`,
      `light leak ${percent(result.shares.lightLeak)} of the points seen`);
  }
  return facts.join(" · ");
}

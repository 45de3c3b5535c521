"use strict";

// Soft frames are painted: a frame has two pictures, of the sky's light and of the whole light's, and
// each method its visibility by light. Pictures are decoded when they are first shown.
const decoded = new Map();

// Grey levels of a picture within the page, from 0 to 255, a pixel each.
function levels(source) {
  if (!decoded.has(source)) decoded.set(source, decode(source));
  return decoded.get(source);
}

async function decode(source) {
  const image = new Image();
  image.src = source;
  await image.decode();
  const canvas = document.createElement("canvas");
  canvas.width = image.naturalWidth;
  canvas.height = image.naturalHeight;
  const context = canvas.getContext("2d", { willReadFrequently: true });
  context.drawImage(image, 0, 0);
  const { data } = context.getImageData(0, 0, canvas.width, canvas.height);
  return Uint8Array.from({ length: data.length / 4 }, (_, i) => data[4 * i]);
}

const grey = (level) => [level, level, level, 255];

// Colour of an error of visibility: white without one, whole from `full` on.
function errorColour(error, { full, shades, dark, bright }) {
  const share = Math.round(shades * Math.min(Math.abs(error) / full, 1)) / shades;
  const [r, g, b] = error < 0 ? dark : bright;
  return [255 - share * (255 - r), 255 - share * (255 - g), 255 - share * (255 - b), 255];
}

function softPainter(errors) {
  const newest = new Map(); // choice by layer

  return async function paint(layer, choice) {
    newest.set(layer, choice);
    layer.setAttribute("aria-busy", "true");
    const { item, pictures, key, shown, alt } = choice;
    const sources = [item.direct, item.sky, pictures[key].visibility, pictures.reference.visibility];
    const [direct, sky, visibility, exact] = await Promise.all(sources.map(levels));
    if (newest.get(layer) !== choice) return; // a later choice
    const colourOf = {
      shaded: (i) => grey(sky[i] + direct[i] * visibility[i] / 255),
      visibility: (i) => grey(visibility[i]),
      errors: (i) => errorColour((visibility[i] - exact[i]) / 255, errors),
    }[shown];
    const [canvas] = layer.children;
    canvas.width = item.width;
    canvas.height = item.height;
    canvas.setAttribute("aria-label", alt);
    const picture = new ImageData(item.width, item.height);
    for (let i = 0; i < visibility.length; i++) picture.data.set(colourOf(i), 4 * i);
    canvas.getContext("2d").putImageData(picture, 0, 0);
    layer.setAttribute("aria-busy", "false");
  };
}

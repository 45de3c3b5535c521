"use strict";

// Hard frames are images: over the reference lies what a method changes, and over that its errors;
// the reference has neither, and no map.
function paintHard(layer, { item, pictures, key, shown, alt }) {
  const picture = pictures[key];
  const map = shown === "map" && picture.map;
  const [image, ...others] = layer.children;
  image.src = map || item.reference;
  image.alt = alt;
  [!map && picture.change, shown === "errors" && picture.errors].forEach((source, i) => {
    others[i].hidden = !source;
    if (source) others[i].src = source;
  });
}

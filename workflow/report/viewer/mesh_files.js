// Mesh files that a reader opens: OBJ, PLY and STL, as vertices (3 numbers each) and faces (3 each).

class Unreadable extends Error {}

const MOST_FILE = 300e6; // bytes; a browser's tab ends not far beyond

async function readMesh(file) {
  const read = { obj: readObj, ply: readPly, stl: readStl }[file.name.toLowerCase().split(".").at(-1)];
  if (!read) throw new Unreadable(`${file.name}: not a mesh that is read here. Open an OBJ, PLY or STL file.`);
  if (file.size > MOST_FILE) {
    throw new Unreadable(`${file.name}: ${(file.size / 1e6).toFixed(0)} MB, more than ${MOST_FILE / 1e6}. Decimate it first.`);
  }
  try {
    const mesh = read(await file.arrayBuffer()), count = mesh.vertices.length / 3;
    if (!mesh.faces.length) throw new Error("no triangles in it");
    if (mesh.faces.some((i) => !(i >= 0 && i < count))) throw new Error("a face of a vertex that is not there");
    if (!mesh.vertices.every(Number.isFinite)) throw new Error("a vertex that is no number");
    return mesh;
  } catch (error) {
    throw new Unreadable(`${file.name}: ${error.message}. Export it anew as OBJ, PLY or STL.`);
  }
}

const textOf = (bytes, ...range) => new TextDecoder().decode(new Uint8Array(bytes, ...range));

// A polygon's corners as triangles.
function addPolygon(faces, corners) {
  for (let k = 2; k < corners.length; k++) faces.push(corners[0], corners[k - 1], corners[k]);
}

function readObj(bytes) {
  const vertices = [], faces = [];
  for (const [, word, rest] of textOf(bytes).matchAll(/^[ \t]*(v|f)[ \t]+(.*)$/gm)) {
    const parts = rest.trim().split(/\s+/);
    if (word === "v") vertices.push(...parts.slice(0, 3).map(Number));
    else addPolygon(faces, parts.map(parseFloat).map((i) => i < 0 ? vertices.length / 3 + i : i - 1));
  }
  return { vertices, faces };
}

const PLY_TYPES = {
  char: "Int8", uchar: "Uint8", short: "Int16", ushort: "Uint16", int: "Int32", uint: "Uint32",
  float: "Float32", double: "Float64", int8: "Int8", uint8: "Uint8", int16: "Int16", uint16: "Uint16",
  int32: "Int32", uint32: "Uint32", float32: "Float32", float64: "Float64",
};

function readPly(bytes) {
  // A character a byte, whatever a comment is written in: the data begin at the header's length.
  const start = new TextDecoder("latin1").decode(new Uint8Array(bytes, 0, Math.min(bytes.byteLength, 65536)));
  const header = start.match(/^ply\s[^]*?end_header\r?\n/)?.[0];
  if (!header) throw new Error("no header of a PLY file");
  const format = header.match(/^format (\w+)/m)?.[1];
  const elements = header.split(/^element /m).slice(1).map((text) => ({
    name: text.split(/\s/)[0], count: Number(text.split(/\s/)[1]),
    properties: [...text.matchAll(/^property (?:list (\w+) )?(\w+) (\w+)/gm)],
  }));
  const next = format === "ascii" ? wordsOf(textOf(bytes, header.length))
    : numbersOf(new DataView(bytes, header.length), format === "binary_little_endian");
  const vertices = [], faces = [];
  for (const { name, count, properties } of elements) {
    for (let i = 0; i < count; i++) {
      for (const [, length, type, property] of properties) {
        const values = Array.from({ length: length ? next(length) : 1 }, () => next(type));
        if (name === "vertex" && "xyz".includes(property)) vertices.push(values[0]);
        if (name === "face" && /^vertex_ind/.test(property)) addPolygon(faces, values);
      }
    }
  }
  return { vertices, faces };
}

function wordsOf(text) {
  const words = text.matchAll(/\S+/g);
  return () => Number(words.next().value?.[0] ?? NaN);
}

function numbersOf(view, little) {
  let at = 0;
  return (type) => {
    const kind = PLY_TYPES[type], first = at;
    at += Number(kind.match(/\d+/)[0]) / 8;
    return view[`get${kind}`](first, little);
  };
}

function readStl(bytes) {
  const count = bytes.byteLength >= 84 ? new DataView(bytes).getUint32(80, true) : 0;
  const places = bytes.byteLength === 84 + 50 * count ? new Float32Array(9 * count)
    : [...textOf(bytes).matchAll(/vertex\s+(\S+)\s+(\S+)\s+(\S+)/g)].flatMap((match) => match.slice(1).map(Number));
  if (places instanceof Float32Array) {
    const view = new DataView(bytes);
    places.forEach((_, i) => { places[i] = view.getFloat32(96 + 50 * Math.floor(i / 9) + 4 * (i % 9), true); });
  }
  // Corners of the same place are one vertex: its normal is the mean of its faces'.
  const vertices = [], numbers = new Map(), faces = new Uint32Array(places.length / 3);
  for (let i = 0; i < places.length; i += 3) {
    const place = [places[i], places[i + 1], places[i + 2]], key = place.join();
    if (!numbers.has(key)) {
      numbers.set(key, vertices.length / 3);
      vertices.push(...place);
    }
    faces[i / 3] = numbers.get(key);
  }
  return { vertices, faces };
}

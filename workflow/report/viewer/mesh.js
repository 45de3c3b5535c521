// The object: triangles as viewer/mesh_arrays.py writes them.

async function unpackMesh({ steps, codes, bits }) {
  const [zigzags, lags] = await Promise.all([unpack(steps), unpack(codes)]);
  const count = zigzags.length / 3, last = 2 ** bits - 1;
  const vertices = new Float32Array(zigzags.length);
  for (let axis = 0; axis < 3; axis++) {
    for (let i = 0, whole = 0; i < count; i++) {
      whole += signed(zigzags[axis * count + i]);
      vertices[3 * i + axis] = whole / last * 2 - 1;
    }
  }
  const faces = new Uint32Array(lags.length);
  for (let i = 0, next = 0; i < lags.length; i++) {
    faces[i] = next - lags[i];
    if (lags[i] === 0) next++;
  }
  return { vertices, faces };
}

// Each triangle's corners by themselves, (faces · 9): positions, vertex normals, face normals. A
// vertex's normal is the mean of its faces', by angle (meshes/prepared_mesh.py).
function corners({ vertices, faces }) {
  const positions = new Float32Array(3 * faces.length), normals = new Float32Array(vertices.length);
  const faceNormals = new Float32Array(3 * faces.length);
  const vertex = (i) => vertices.subarray(3 * i, 3 * i + 3);
  for (let first = 0; first < faces.length; first += 3) {
    const [a, b, c] = [0, 1, 2].map((k) => Array.from(vertex(faces[first + k])));
    const edges = [plus(b, a, -1), plus(c, b, -1), plus(a, c, -1)].map(unit);
    const normal = unit(cross(edges[0], edges[1]));
    for (let k = 0; k < 3; k++) {
      const angle = Math.acos(clamped(-dot(edges[k], edges[(k + 2) % 3]), -1, 1));
      const target = normals.subarray(3 * faces[first + k]);
      for (let axis = 0; axis < 3; axis++) target[axis] += angle * normal[axis] || 0;
      positions.set(vertex(faces[first + k]), 3 * (first + k));
      faceNormals.set(normal, 3 * (first + k));
    }
  }
  for (let i = 0; i < normals.length; i += 3) { // one where faces cancel: the shader takes theirs
    const length = Math.hypot(normals[i], normals[i + 1], normals[i + 2]) || 1;
    for (let axis = 0; axis < 3; axis++) normals[i + axis] /= length;
  }
  const vertexNormals = new Float32Array(3 * faces.length);
  faces.forEach((i, at) => vertexNormals.set(normals.subarray(3 * i, 3 * i + 3), 3 * at));
  return { positions, vertexNormals, faceNormals };
}

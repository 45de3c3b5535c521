"""Writers of mesh files that write whatever they are given, as no library does."""

import json

import numpy as np

TETRAHEDRON = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
TETRAHEDRON_FACES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])


def ply_header(encoding: str, vertices: int, faces: int) -> str:
    lines = ["ply", f"format {encoding} 1.0", "comment element face 99"]
    lines += [f"element vertex {vertices}", *(f"property double {axis}" for axis in "xyz")]
    lines += [f"element face {faces}", "property list uchar int vertex_indices", "end_header", ""]
    return "\n".join(lines)


def ascii_ply(vertices, faces) -> bytes:
    """Polygons may have any number of corners."""
    rows = [" ".join(map(str, vertex)) for vertex in np.asarray(vertices).tolist()]
    rows += [" ".join(map(str, [len(face), *face])) for face in faces]
    return (ply_header("ascii", len(vertices), len(faces)) + "\n".join(rows) + "\n").encode()


def binary_ply(vertices, faces) -> bytes:
    rows = np.zeros(len(faces), dtype=[("n", "u1"), ("corners", "<i4", 3)])
    rows["n"], rows["corners"] = 3, np.reshape(faces, (-1, 3))
    header = ply_header("binary_little_endian", len(vertices), len(faces)).encode()
    return header + np.asarray(vertices, "<f8").tobytes() + rows.tobytes()


def obj(vertices, faces) -> bytes:
    lines = [f"v {x} {y} {z}" for x, y, z in np.asarray(vertices).tolist()]
    lines += ["f " + " ".join(str(i + 1) for i in face) for face in faces]
    return ("\n".join(lines) + "\n").encode()


def _corners(vertices, faces) -> np.ndarray:
    """An STL has corners and no indices: what is no index is another one."""
    if not len(vertices):
        return np.zeros((0, 3, 3))
    return np.asarray(vertices, float)[np.asarray(faces, int).reshape(-1, 3) % len(vertices)]


def binary_stl(vertices, faces) -> bytes:
    corners = _corners(vertices, faces)
    rows = np.zeros(len(corners), [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("a", "<u2")])
    with np.errstate(over="ignore"):
        rows["corners"] = corners
    return bytes(80) + np.uint32(len(rows)).tobytes() + rows.tobytes()


def ascii_stl(vertices, faces) -> bytes:
    lines = ["solid thing"]
    for triangle in _corners(vertices, faces).tolist():
        lines += ["facet normal 0 0 0", "outer loop"]
        lines += [f"vertex {x} {y} {z}" for x, y, z in triangle]
        lines += ["endloop", "endfacet"]
    return "\n".join([*lines, "endsolid thing", ""]).encode()


def glb(vertices, faces) -> bytes:
    with np.errstate(over="ignore"):
        positions = np.asarray(vertices, "<f4").tobytes()
    indices = np.asarray(faces, "<i4").astype("<u4").tobytes()
    return pack_glb(glb_tree(len(vertices), 3 * len(faces)), positions + indices)


def glb_tree(vertices: int, indices: int) -> dict:
    """The JSON part of one mesh whose positions and indices follow each other."""
    views = [(0, 12 * vertices), (12 * vertices, 4 * indices)]
    kinds = [(5126, vertices, "VEC3"), (5125, indices, "SCALAR")]
    return {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": i, "componentType": component, "count": count, "type": kind}
            for i, (component, count, kind) in enumerate(kinds)
        ],
        "bufferViews": [{"buffer": 0, "byteOffset": o, "byteLength": n} for o, n in views],
        "buffers": [{"byteLength": 12 * vertices + 4 * indices}],
    }


def pack_glb(tree: object, binary: bytes) -> bytes:
    text = tree if isinstance(tree, bytes) else json.dumps(tree).encode()
    text += b" " * (-len(text) % 4)
    binary += bytes(-len(binary) % 4)
    chunks = b"".join(
        np.uint32(len(content)).tobytes() + kind + content
        for kind, content in ((b"JSON", text), (b"BIN\0", binary))
    )
    return b"glTF" + np.array([2, 12 + len(chunks)], "<u4").tobytes() + chunks


# By the name of the file that they make.
WRITERS = {
    "source.ply": binary_ply,
    "ascii.ply": ascii_ply,
    "source.obj": obj,
    "source.stl": binary_stl,
    "ascii.stl": ascii_stl,
    "source.glb": glb,
}

"""Mesh files of all formats; of those that are text, with whatever they are given."""

from functools import partial

import numpy as np
import trimesh

TETRAHEDRON = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
TETRAHEDRON_FACES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])


def ascii_ply(vertices, faces) -> bytes:
    """Polygons may have any number of corners."""
    lines = ["ply", "format ascii 1.0", "comment element face 99"]
    lines += [f"element vertex {len(vertices)}", *(f"property double {axis}" for axis in "xyz")]
    lines += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
    lines += [" ".join(map(str, vertex)) for vertex in np.asarray(vertices).tolist()]
    lines += [" ".join(map(str, [len(face), *face])) for face in faces]
    return ("\n".join(lines) + "\n").encode()


def obj(vertices, faces) -> bytes:
    lines = [f"v {x} {y} {z}" for x, y, z in np.asarray(vertices).tolist()]
    lines += ["f " + " ".join(str(i + 1) for i in face) for face in faces]
    return ("\n".join(lines) + "\n").encode()


def exported(kind: str, vertices, faces) -> bytes:
    """By trimesh, which is what reads them too."""
    with np.errstate(over="ignore"):
        content = trimesh.Trimesh(vertices, faces, process=False).export(file_type=kind)
    return content.encode() if isinstance(content, str) else content


# By the name of the file that they make.
WRITERS = {
    "source.ply": partial(exported, "ply"),
    "ascii.ply": ascii_ply,
    "source.obj": obj,
    "source.stl": partial(exported, "stl"),
    "ascii.stl": partial(exported, "stl_ascii"),
    "source.glb": partial(exported, "glb"),
}

"""Triangles of a mesh in any of the forms that users have."""

import os
from typing import Any

import numpy as np

from neural_shadows.errors import InputError

FORMS = "a path, a trimesh.Trimesh, or (vertices (V, 3), faces (F, 3))"


def triangles_of(mesh: Any) -> tuple[np.ndarray, np.ndarray, str]:
    """Vertices (V, 3) float64, faces (F, 3) int64, and a name for messages.

    Args:
        mesh: see `FORMS`; of a path those of `read_mesh`, of trimesh also a Scene.

    Raises:
        InputError: none of these, or as `read_mesh`.
    """
    if isinstance(mesh, (str, os.PathLike)):
        from neural_shadows.meshes.reading import read_mesh

        return *read_mesh(mesh), str(mesh)
    if hasattr(mesh, "to_mesh"):  # trimesh.Scene
        mesh = mesh.to_mesh()
    if hasattr(mesh, "vertices") and hasattr(mesh, "faces"):
        mesh = mesh.vertices, mesh.faces
    try:
        vertices, faces = (np.asarray(part) for part in mesh)
    except (TypeError, ValueError):
        raise InputError(f"mesh: a {type(mesh).__name__}. Give {FORMS}.") from None
    for name, array, kinds in (("vertices", vertices, "fiu"), ("faces", faces, "iu")):
        if array.ndim != 2 or array.shape[1] != 3 or array.dtype.kind not in kinds:
            what = "numbers" if name == "vertices" else "integers: triangles, counted from 0"
            raise InputError(
                f"mesh: {name}: {array.dtype} {array.shape}: not (n, 3) {what}. Give {FORMS}."
            )
    if len(faces) == 0:
        raise InputError("mesh: faces: none. Give a mesh with triangles.")
    if faces.min() < 0 or faces.max() >= len(vertices):
        raise InputError(
            f"mesh: faces: indices from {faces.min()} to {faces.max()}, of {len(vertices)} "
            "vertices. Count vertices from 0."
        )
    return vertices.astype(np.float64), faces.astype(np.int64), "given"

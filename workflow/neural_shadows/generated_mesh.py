"""The stage that makes procedural meshes."""

from pathlib import Path

import trimesh

from neural_shadows.files import whole_file
from neural_shadows.wyrm import make_wyrm


def generate_mesh(mesh_ply: str | Path, *, generate: str, cells: int) -> None:
    """Write a procedural mesh as binary PLY.

    Args:
        generate: which mesh; `wyrm` is the only one.
        cells: marching-cubes cells along its longest axis.
    """
    if generate != "wyrm":
        raise ValueError(f"no procedural mesh is named {generate!r}")
    vertices, faces = make_wyrm(cells)
    with whole_file(mesh_ply) as part:
        trimesh.Trimesh(vertices, faces, process=False).export(part, file_type="ply")

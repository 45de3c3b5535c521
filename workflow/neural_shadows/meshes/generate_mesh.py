"""The stage that makes procedural meshes."""

from pathlib import Path
from typing import Any

import trimesh

from neural_shadows.files.whole_files import whole_file
from neural_shadows.meshes.fence import make_fence
from neural_shadows.meshes.landscape import make_landscape
from neural_shadows.meshes.wyrm import make_wyrm

MAKERS = {"wyrm": make_wyrm, "fence": make_fence, "landscape": make_landscape}


def generate_mesh(mesh_ply: str | Path, *, generate: str, **parameters: Any) -> None:
    """Write a procedural mesh as binary PLY.

    Args:
        generate: which mesh, a key of `MAKERS`.
        parameters: what its maker takes, as the scene's `mesh` section names them.
    """
    vertices, faces = MAKERS[generate](**parameters)
    with whole_file(mesh_ply) as part:
        trimesh.Trimesh(vertices, faces, process=False).export(part, file_type="ply")

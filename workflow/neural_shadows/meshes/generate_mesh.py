"""Stage for procedural meshes."""

from pathlib import Path

import trimesh

from neural_shadows.files.whole_files import whole_file
from neural_shadows.meshes.fence import make_fence
from neural_shadows.meshes.landscape import make_landscape
from neural_shadows.meshes.wyrm import make_wyrm
from neural_shadows.running.stage import run_stage
from neural_shadows.settings.records import MeshSource

MAKERS = {"wyrm": make_wyrm, "fence": make_fence, "landscape": make_landscape}


def generate_mesh(generated_ply: Path, mesh: MeshSource) -> None:
    """Write a procedural mesh as binary PLY.

    Args:
        generated_ply: the mesh, in an arbitrary unit.
        mesh: the scene's section: `generate`, a key of `MAKERS`, and the maker's arguments.

    Raises:
        InputError: contradictory parameters.
    """
    parameters = dict(mesh)
    vertices, faces = MAKERS[parameters.pop("generate")](**parameters)
    with whole_file(generated_ply) as part:
        trimesh.Trimesh(vertices, faces, process=False).export(part, file_type="ply")


if "snakemake" in globals():
    run_stage(snakemake, generate_mesh)

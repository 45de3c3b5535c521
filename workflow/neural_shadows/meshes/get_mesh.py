"""Stage for meshes that are generated or downloaded."""

from importlib import import_module
from pathlib import Path
from types import ModuleType

from neural_shadows.files.whole_files import whole_file
from neural_shadows.running.stage import run_stage
from neural_shadows.settings.records import MeshSource


def get_mesh(source_ply: Path, mesh: MeshSource) -> None:
    """Write the mesh of a scene without a mesh file.

    Args:
        source_ply: a procedural mesh as binary PLY, in an arbitrary unit; a downloaded one unchanged.
        mesh: the scene's section: `generate` with its settings, or `download`.

    Raises:
        InputError: contradictory settings; no connection, or another file than the published one.
    """
    settings = dict(mesh)
    if download := settings.pop("download", None):
        _module(download).download_mesh(source_ply)
        return
    name = settings.pop("generate")
    vertices, faces = getattr(_module(name), f"make_{name}")(**settings)

    import trimesh

    with whole_file(source_ply) as part:
        trimesh.Trimesh(vertices, faces, process=False).export(part, file_type="ply")


# By name: a result depends on its own module only, see `Layout.mesh_module`.
def _module(name: str) -> ModuleType:
    return import_module(f"neural_shadows.meshes.{name}")


if "snakemake" in globals():
    run_stage(snakemake, get_mesh)

"""Meshes of the thesis, comparable with its printed values."""

from neural_shadows.settings.records import MeshSource

# dragon_vrip_res2.ply with 202,520 triangles. The thesis does not name its resolution, one of four.
DRAGON_SHA256 = "f64cd2d043551ec82643d9987d1d26d35018238d501b346481e3b89d6e224da4"


def is_thesis_mesh(mesh: MeshSource, sha256: str) -> bool:
    """Check for the dragon or meshes of the thesis's descriptions [4.1.1].

    Args:
        mesh: the scene's `mesh` section.
        sha256: hexadecimal, of the decompressed mesh file.
    """
    return mesh.get("generate") in ("fence", "landscape") or sha256 == DRAGON_SHA256

"""Which meshes are those of the thesis, beside whose results its own values may stand."""

from neural_shadows.settings.records import MeshSource

# Of dragon_vrip_res2.ply, of 202,520 triangles. The thesis does not say which of the four
# resolutions it used.
DRAGON_SHA256 = "f64cd2d043551ec82643d9987d1d26d35018238d501b346481e3b89d6e224da4"


def is_thesis_mesh(mesh: MeshSource, sha256: str) -> bool:
    """Whether a mesh is one of the thesis's: the dragon, or built to its description [4.1.1].

    Args:
        mesh: the scene's `mesh` section.
        sha256: hexadecimal, of the mesh file's content once it is decompressed.
    """
    return mesh.get("generate") in ("fence", "landscape") or sha256 == DRAGON_SHA256

"""Download of the Stanford dragon."""

from pathlib import Path

import pooch

from neural_shadows.files.download import downloaded
from neural_shadows.files.whole_files import sha256_of
from neural_shadows.meshes.thesis_meshes import DRAGON_SHA256
from neural_shadows.running.progress import progress_bar

URL = "https://graphics.stanford.edu/pub/3Dscanrep/dragon/dragon_recon.tar.gz"
ARCHIVE_BYTES = 11_197_764
ARCHIVE_SHA256 = "74ac1d90989c9b1732edee82d57e9ce71452144cf4355f108d8c9c616d28d02f"
MEMBER = "dragon_recon/dragon_vrip_res2.ply"


def download_mesh(source_ply: Path) -> None:
    """Download the dragon's archive, and extract its mesh.

    The mesh has 202,520 triangles.

    Args:
        source_ply: the mesh, unchanged from the archive.

    Raises:
        InputError: no connection, or archive or mesh differ from the published ones.
    """
    with downloaded(
        URL,
        ARCHIVE_SHA256,
        source_ply.parent,
        "Try again, or download it by hand, unpack it, and run with "
        f"`--config dragon=PATH/TO/{Path(MEMBER).name}`",
        pooch.Untar(members=[MEMBER]),
        progress_bar(ARCHIVE_BYTES, "B", "Stanford dragon"),
    ) as unpacked:
        if [sha256_of(path) for path in unpacked] != [DRAGON_SHA256]:
            raise ValueError(f"{MEMBER} is missing, or not as published")
        unpacked[0].replace(source_ply)

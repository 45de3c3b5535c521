"""The stage that fetches the Stanford dragon from the Stanford 3D Scanning Repository."""

from pathlib import Path
from tempfile import TemporaryDirectory

import pooch

from neural_shadows.errors import InputError
from neural_shadows.files.whole_files import sha256_of
from neural_shadows.meshes.thesis_meshes import DRAGON_SHA256
from neural_shadows.running.progress import progress_bar
from neural_shadows.running.stage import run_stage

URL = "https://graphics.stanford.edu/pub/3Dscanrep/dragon/dragon_recon.tar.gz"
ARCHIVE_BYTES = 11_197_764
ARCHIVE_SHA256 = "74ac1d90989c9b1732edee82d57e9ce71452144cf4355f108d8c9c616d28d02f"
MEMBER = "dragon_recon/dragon_vrip_res2.ply"


def download_mesh(downloaded_ply: Path) -> None:
    """Download the archive of the dragon, and take the mesh of 202,520 triangles out of it.

    A download that is cut begins again with the next attempt.

    Args:
        downloaded_ply: where the mesh goes, as it is in the archive.

    Raises:
        InputError: no connection, or an archive or a mesh that is not the published one.
    """
    downloaded_ply.parent.mkdir(parents=True, exist_ok=True)
    try:
        with TemporaryDirectory(dir=downloaded_ply.parent) as folder:
            unpacked = pooch.retrieve(
                URL,
                known_hash=f"sha256:{ARCHIVE_SHA256}",
                path=folder,
                fname=Path(URL).name,
                processor=pooch.Untar(members=[MEMBER]),
                progressbar=progress_bar(ARCHIVE_BYTES, "B", "Stanford dragon"),
            )
            if [sha256_of(path) for path in unpacked] != [DRAGON_SHA256]:
                raise ValueError(f"{MEMBER} is not in it, or not as published")
            Path(unpacked[0]).replace(downloaded_ply)
    except (OSError, ValueError) as error:  # of requests, and of a digest
        reason = " ".join(str(error).split())[:300]
        raise InputError(
            f"cannot download {URL}: {reason}; try again, or download it by hand, unpack it, and "
            f"run with `--config dragon=PATH/TO/{Path(MEMBER).name}`"
        ) from error


if "snakemake" in globals():
    run_stage(snakemake, download_mesh)

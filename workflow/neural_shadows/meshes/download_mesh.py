"""The Stanford dragon, from its archive in the Stanford 3D Scanning Repository."""

import hashlib
import io
import tarfile
from pathlib import Path

from neural_shadows.errors import InputError
from neural_shadows.files.download import fetch
from neural_shadows.files.gzip_file import unpack
from neural_shadows.files.whole_files import whole_file

DRAGON_URL = "https://graphics.stanford.edu/pub/3Dscanrep/dragon/dragon_recon.tar.gz"

# Of the whole archive (11,197,764 bytes), checked before anything in it is read.
ARCHIVE_SHA256 = "74ac1d90989c9b1732edee82d57e9ce71452144cf4355f108d8c9c616d28d02f"

# The thesis does not say which of the four resolutions it used. This is the second, of
# 202,520 triangles.
DRAGON_MEMBER = "dragon_recon/dragon_vrip_res2.ply"
DRAGON_SHA256 = "f64cd2d043551ec82643d9987d1d26d35018238d501b346481e3b89d6e224da4"

# Several times what the archive weighs, packed and unpacked, and its largest member.
MAX_ARCHIVE_BYTES = 200 * 2**20
MAX_UNPACKED_BYTES = 400 * 2**20
MAX_MEMBER_BYTES = 200 * 2**20


def fetch_stanford_dragon(
    path_ply: str | Path,
    *,
    archive: str | Path | None = None,
    url: str = DRAGON_URL,
    archive_sha256: str = ARCHIVE_SHA256,
    member: str = DRAGON_MEMBER,
    sha256: str = DRAGON_SHA256,
    tries: int = 4,
    backoff_s: float = 1,
) -> None:
    """Download the archive of the dragon and take the one mesh out of it.

    Args:
        path_ply: where the mesh goes, as it is in the archive.
        archive: a copy of the archive on disk, instead of the download.
        url, archive_sha256: of the archive (`.tar.gz`).
        member: name of the mesh in it.
        sha256: of the mesh, in hexadecimal.
        tries, backoff_s: as `download.fetch`.

    Raises:
        InputError: no connection, a damaged archive, or a mesh that is missing in it or
            changed. Nothing is left behind then but what has come of the archive, from which the
            next call goes on.
    """
    remedy = (
        f"download {url} by hand, unpack it, and run with "
        f"`--config dragon=PATH/TO/{Path(member).name}` (any .ply or .ply.gz) instead"
    )
    if archive is not None:
        _extract(Path(archive), member, sha256, path_ply, remedy)
        return
    downloaded = Path(path_ply).with_name(Path(url).name)
    fetch(
        url,
        downloaded,
        sha256=archive_sha256,
        max_bytes=MAX_ARCHIVE_BYTES,
        remedy=remedy,
        label="Stanford dragon",
        tries=tries,
        backoff_s=backoff_s,
    )
    try:
        _extract(downloaded, member, sha256, path_ply, remedy)
    finally:
        downloaded.unlink()


def _extract(archive: Path, member: str, sha256: str, path_ply: str | Path, remedy: str) -> None:
    """Write one regular file of an archive to `path_ply`, if its digest is right.

    Nothing is unpacked by the names in the archive, so links and `..` lead nowhere.
    """
    try:
        tarred = io.BytesIO(unpack(archive, MAX_UNPACKED_BYTES))
        with tarfile.open(fileobj=tarred, mode="r:") as tar:
            info = next((info for info in tar if info.name == member and info.isfile()), None)
            if info is None:
                raise InputError(f"archive {archive.name}: no file {member} in it; {remedy}")
            if info.size > MAX_MEMBER_BYTES:
                raise InputError(
                    f"archive {archive.name}: {member} has {info.size:,} bytes, more than the "
                    f"{MAX_MEMBER_BYTES:,} allowed; {remedy}"
                )
            content = tar.extractfile(info).read()
    except FileNotFoundError:
        raise InputError(f"archive {archive}: no such file; {remedy}") from None
    except (tarfile.TarError, ValueError, OverflowError, OSError) as error:
        raise InputError(
            f"archive {archive.name}: damaged or truncated ({error}); {remedy}"
        ) from error
    found = hashlib.sha256(content).hexdigest()
    if found != sha256:
        raise InputError(
            f"archive {archive.name}: the SHA-256 of {member} is {found}, where {sha256} is "
            f"expected; {remedy}"
        )
    with whole_file(path_ply) as part:
        part.write_bytes(content)

"""Whether a run can write its results, found out before its first job."""

import os
from collections.abc import Iterable
from pathlib import Path

from neural_shadows.errors import InputError


def check_writable(folders: Iterable[str | Path]) -> None:
    """Check that files can be made in folders, or in the nearest ones that are there.

    Raises:
        InputError: names the first where they cannot.
    """
    for folder in map(Path, folders):
        nearest = next(path for path in (folder, *folder.absolute().parents) if path.exists())
        if not nearest.is_dir():
            raise InputError(f"{nearest}: is no folder, and results go there; move it away")
        if not os.access(nearest, os.W_OK | os.X_OK):
            read_only = os.statvfs(nearest).f_flag & os.ST_RDONLY
            reason = "it is on a read-only file system" if read_only else "permission denied"
            raise InputError(
                f"{nearest}: cannot be written: {reason}; make it writable, or run in a copy of "
                "the checkout that is"
            )

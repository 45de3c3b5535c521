"""What would stop a run in its middle, found before its first job: disks and clocks."""

import os
import shlex
import time
from collections.abc import Iterable
from pathlib import Path

from neural_shadows.errors import InputError

# Clocks of this machine and of a file server may differ by less: no job is done sooner.
CLOCK_SLACK_S = 2


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


def check_clock(folders: Iterable[str | Path]) -> None:
    """Check that no file is from the future.

    Where the clock was set back, Snakemake takes new results for older than what they are made
    from, and edits for older than the results that they outdate.

    Raises:
        InputError: names the latest file, and how to date those from the future to now.
    """
    folders = [str(folder) for folder in folders if os.path.exists(folder)]
    times = ((os.lstat(path).st_mtime, path) for folder in folders for path in _files(folder))
    latest, path = max(times, default=(0, ""))
    ahead = latest - time.time()
    if ahead > CLOCK_SLACK_S:
        raise InputError(
            f"{path}: was written {ahead:,.0f} s in the future: was the clock set back? Set it "
            f"right, or date such files to now: find {shlex.join(folders)} -newermt now "
            '-exec touch -d "$(date)" {} +'
        )


def _files(folder: str) -> Iterable[str]:
    for parent, _, names in os.walk(folder):
        yield from (os.path.join(parent, name) for name in names)

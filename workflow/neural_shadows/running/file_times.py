"""Files from the future: what a clock that was set back leaves, and how to date them to now.

python -m neural_shadows.running.file_times FOLDER ...
"""

import os
import shlex
import sys
import time
from collections.abc import Iterable
from pathlib import Path

from neural_shadows.errors import InputError

# The clock of a file server may be ahead of this machine's; all files then have the server's time.
SLACK_S = 60


def check_clock(folders: Iterable[str | Path]) -> None:
    """Check that no file is from the future.

    Where the clock was set back, Snakemake takes new results for older than what they are made
    of, and fails when they are done, and edits for older than the results that they outdate.

    Raises:
        InputError: names the latest file, and what to do.
    """
    folders = [str(folder) for folder in folders]
    times = _files_from_the_future(folders, SLACK_S)
    if times:
        latest = max(times, key=times.get)
        ahead = times[latest] / 1e9 - time.time()
        raise InputError(
            f"{latest}: was written {ahead:,.0f} s in the future. If the clock is wrong, set it "
            "right. If it was, date such files to now, in their order, and then touch what you "
            f"have edited since: python -m neural_shadows.running.file_times {shlex.join(folders)}"
        )


def date_to_now(folders: Iterable[str | Path]) -> int:
    """Date the files from the future to just before now, in the order of their times.

    Returns:
        How many there were.
    """
    times = _files_from_the_future(folders, 0)
    order = {moment: i for i, moment in enumerate(sorted({*times.values()}, reverse=True), 1)}
    now = time.time_ns()
    for path, moment in times.items():
        # A microsecond apart: file systems have coarser clocks, but keep what they are given.
        os.utime(path, ns=(now, now - 1000 * order[moment]), follow_symlinks=False)
    return len(times)


def _files_from_the_future(folders: Iterable[str | Path], slack_s: float) -> dict[str, int]:
    """Times of modification in ns, by path."""
    latest = time.time_ns() + round(1e9 * slack_s)
    found = {}
    for folder in folders:
        for parent, _, names in os.walk(folder):
            for path in (os.path.join(parent, name) for name in names):
                try:
                    moment = os.lstat(path).st_mtime_ns
                except OSError:
                    continue  # another run's temporary file, or another user's
                if moment > latest:
                    found[path] = moment
    return found


if __name__ == "__main__":
    print(f"{date_to_now(sys.argv[1:])} files dated to now")

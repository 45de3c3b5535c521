"""A run of Snakemake that is ended from outside, and a disk that fills."""

import os
import signal
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from checkout import Checkout

POLL_S = 0.002

# Within which all processes of a run end after a signal. It takes a second; but a machine that is
# busy with other things lets a process of low priority wait for minutes.
END_S = 600


def interrupt(
    checkout: Checkout,
    targets: list[str],
    sign: signal.Signals,
    is_time: Callable[[], bool],
    overlays: list[Path],
) -> bool:
    """Start a run, send all its processes a signal when it is time, and wait for their end.

    Then the folder must not be locked, except after SIGKILL, and is unlocked.

    Returns:
        False if the run came to a good end before.
    """
    output = checkout.folder / "said.txt"
    with (
        output.open("w") as file,
        subprocess.Popen(
            checkout.command(*targets, overlays=overlays),
            cwd=checkout.folder,
            env=checkout.environment(),
            stdout=file,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        ) as run,
    ):
        try:
            while run.poll() is None and not is_time():
                time.sleep(POLL_S)
            if run.poll() is None:
                os.killpg(run.pid, sign)
            deadline = time.monotonic() + END_S
            # Snakemake itself is a zombie until `poll` takes note of its end.
            while run.poll() is None or members(run.pid):
                assert time.monotonic() < deadline, f"{members(run.pid)} run on after {sign.name}"
                time.sleep(POLL_S)
        finally:
            if members(run.pid):
                os.killpg(run.pid, signal.SIGKILL)
    if run.returncode == 0:
        return False
    if any(checkout.folder.glob(".snakemake/locks/*.lock")):
        assert sign == signal.SIGKILL, f"locked after {sign.name}:\n{output.read_text()}"
        checkout.run("--unlock", overlays=overlays)
    return True


def members(group: int) -> list[int]:
    """Processes of a group that have not ended."""
    found = []
    for pid in map(int, filter(str.isdigit, os.listdir("/proc"))):
        try:
            # State and group come after a name in brackets, which may hold anything.
            stat = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
        except (FileNotFoundError, ProcessLookupError):
            continue  # it has just ended
        if int(stat[2]) == group and stat[0] != "Z":
            found.append(pid)
    return found


@contextmanager
def small_disk(folder: Path, size: int) -> Iterator[None]:
    """A file system in memory of so many bytes at a folder; `resize` makes it larger."""
    mount = ["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", folder]
    done = subprocess.run(mount, capture_output=True, text=True)
    if done.returncode:
        pytest.skip(f"mount is not permitted here: {done.stderr.strip()}")
    try:
        yield
    finally:
        subprocess.run(["umount", "--lazy", folder], check=True)


def resize(folder: Path, size: int) -> None:
    """Give a small disk another size, bytes; not less than what is on it."""
    subprocess.run(["mount", "-o", f"remount,size={size}", folder], check=True)

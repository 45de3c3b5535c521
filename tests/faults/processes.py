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

# Given the process group of a run: whether it is time to end it.
Moment = Callable[[int], bool]


def interrupt(
    checkout: Checkout, targets: list[str], sign: signal.Signals, moment: Moment, **settings
) -> bool:
    """Start a run, send all its processes a signal at a moment, and wait for their end.

    Then the folder must not be locked, except after SIGKILL, and is unlocked.

    Returns:
        False if the run came to a good end before.
    """
    output = checkout.folder / "said.txt"
    with (
        output.open("w") as file,
        subprocess.Popen(
            checkout.command(*targets, **settings),
            cwd=checkout.folder,
            env=checkout.environment(),
            stdout=file,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        ) as run,
    ):
        try:
            while run.poll() is None and not moment(run.pid):
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
        checkout.run("--unlock", **settings)
    return True


def members(group: int) -> list[int]:
    """Processes of a group that have not ended."""
    found = []
    for pid in map(int, filter(str.isdigit, os.listdir("/proc"))):
        try:
            if os.getpgid(pid) != group:
                continue
            # The state comes after a name in brackets, which may hold anything.
            state = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
        except (FileNotFoundError, ProcessLookupError):
            continue  # it has just ended
        if state != "Z":
            found.append(pid)
    return found


def works(group: int) -> bool:
    """Whether one of the processes runs a job's script."""
    for pid in members(group):
        try:
            arguments = Path(f"/proc/{pid}/cmdline").read_bytes().split(b"\0")
        except (FileNotFoundError, ProcessLookupError):
            continue
        # Of bash, which starts it, the script is not an argument of its own.
        if any(b"/.snakemake/scripts/" in argument for argument in arguments[1:2]):
            return True
    return False


def after(seconds: float) -> Moment:
    """When a job has worked for so long."""
    begun: list[float] = []

    def moment(group: int) -> bool:
        if not begun and works(group):
            begun.append(time.monotonic())
        return bool(begun) and time.monotonic() >= begun[0] + seconds

    return moment


def writes(files: list[Path]) -> Moment:
    """As soon as one of these files, none of which is there, or a part of it is written."""
    return lambda group: any(
        file.exists() or any(file.parent.glob(f".*{file.name}*")) for file in files
    )


@contextmanager
def small_disk(folder: Path, size: int) -> Iterator[None]:
    """A file system in memory of so many bytes at a folder; `resize` makes it larger."""
    folder.mkdir(exist_ok=True)
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

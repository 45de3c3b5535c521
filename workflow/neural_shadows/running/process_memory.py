"""Memory of this process, held and available, on Linux."""

import re
from pathlib import Path

CONTAINER = Path("/sys/fs/cgroup/memory.max")  # bytes, or "max" without a limit


def held_bytes() -> int:
    """Resident bytes."""
    return _kilobytes("/proc/self/status", "VmRSS")


def peak_bytes() -> int:
    """Largest resident bytes so far.

    `getrusage` would include the parent process: 1,510 MiB for one of 32 MiB.
    """
    return _kilobytes("/proc/self/status", "VmHWM")


def available_bytes() -> int:
    """Bytes available without swapping, at most the container's limit."""
    machine = _kilobytes("/proc/meminfo", "MemAvailable")
    most = CONTAINER.read_text().strip() if CONTAINER.is_file() else "max"
    return machine if most == "max" else min(machine, int(most))


def _kilobytes(file: str, key: str) -> int:
    text = Path(file).read_text()
    return 1024 * int(re.search(rf"^{key}:\s*(\d+) kB", text, re.MULTILINE)[1])

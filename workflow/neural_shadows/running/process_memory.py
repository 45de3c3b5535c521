"""How much memory this process holds and may take, in bytes, as Linux tells."""

import re
from pathlib import Path

CONTAINER = Path(
    "/sys/fs/cgroup/memory.max"
)  # the most that a container may take, if it is limited


def held_bytes() -> int:
    """What it holds now."""
    return _kilobytes("/proc/self/status", "VmRSS")


def peak_bytes() -> int:
    """The most that it ever held.

    `getrusage` would count what the process that started it held: 1,510 MiB for one of 32 MiB.
    """
    return _kilobytes("/proc/self/status", "VmHWM")


def available_bytes() -> int:
    """What it may still take without swapping, and no more than its container may in all."""
    machine = _kilobytes("/proc/meminfo", "MemAvailable")
    most = CONTAINER.read_text().strip() if CONTAINER.is_file() else "max"
    return machine if most == "max" else min(machine, int(most))


def _kilobytes(file: str, key: str) -> int:
    text = Path(file).read_text()
    return 1024 * int(re.search(rf"^{key}:\s*(\d+) kB", text, re.MULTILINE)[1])

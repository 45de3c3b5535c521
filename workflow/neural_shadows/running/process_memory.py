"""Memory available to this process, on Linux."""

import re
from pathlib import Path

CONTAINER = Path("/sys/fs/cgroup")  # `memory.max`: bytes, or "max" without a limit


def available_bytes() -> int:
    """Bytes available without swapping, at most what the container's limit leaves."""
    text = Path("/proc/meminfo").read_text()
    machine = 1024 * _number("MemAvailable:", text)
    limit = CONTAINER / "memory.max"
    most = limit.read_text().strip() if limit.is_file() else "max"
    if most == "max":
        return machine
    used = int((CONTAINER / "memory.current").read_text())
    # Pages of files that were read some time ago: dropped when memory is needed.
    dropped = _number("inactive_file", (CONTAINER / "memory.stat").read_text())
    return max(0, min(machine, int(most) - used + dropped))


def _number(name: str, text: str) -> int:
    return int(re.search(rf"^{name}\s+(\d+)", text, re.MULTILINE)[1])

"""Memory available to this process, on Linux."""

import re
from pathlib import Path

CONTAINER = Path("/sys/fs/cgroup/memory.max")  # bytes, or "max" without a limit


def available_bytes() -> int:
    """Bytes available without swapping, at most the container's limit."""
    text = Path("/proc/meminfo").read_text()
    machine = 1024 * int(re.search(r"^MemAvailable:\s*(\d+) kB", text, re.MULTILINE)[1])
    most = CONTAINER.read_text().strip() if CONTAINER.is_file() else "max"
    return machine if most == "max" else min(machine, int(most))

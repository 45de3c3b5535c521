"""How much memory this process holds, in bytes, as Linux tells."""

import re
from pathlib import Path


def held_bytes() -> int:
    """What it holds now."""
    return _status("VmRSS")


def peak_bytes() -> int:
    """The most that it ever held.

    `getrusage` would count what the process that started it held: 1,510 MiB for one of 32 MiB.
    """
    return _status("VmHWM")


def _status(key: str) -> int:
    text = Path("/proc/self/status").read_text()
    return 1024 * int(re.search(rf"^{key}:\s*(\d+) kB", text, re.MULTILINE)[1])

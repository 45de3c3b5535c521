"""How much memory this process holds, in bytes; None where the system does not tell (no Linux)."""

import re
from pathlib import Path

_STATUS = Path("/proc/self/status")


def held_bytes() -> int | None:
    """What it holds now."""
    return _status("VmRSS")


def peak_bytes() -> int | None:
    """The most that it ever held.

    `getrusage` would count what the process that started it held: 1,510 MiB for one of 32 MiB.
    """
    return _status("VmHWM")


def _status(key: str) -> int | None:
    text = _STATUS.read_text() if _STATUS.is_file() else ""
    found = re.search(rf"^{key}:\s*(\d+) kB", text, re.MULTILINE)
    return 1024 * int(found[1]) if found else None

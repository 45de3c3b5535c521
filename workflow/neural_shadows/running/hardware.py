"""What machine a result was made on."""

import os
import platform
import re
import sys
from importlib.metadata import version
from pathlib import Path
from typing import Any

CPUINFO = Path("/proc/cpuinfo")


def describe_machine() -> dict[str, Any]:
    """CPU, usable cores, GPU and versions; no host name, user or path: results are published."""
    # A stage that has not loaded it needs no GPU, and loading takes seconds.
    torch = sys.modules.get("torch")
    # Linux on x86 names its CPU there, others nowhere.
    found = CPUINFO.is_file() and re.search(r"^model name\s*: (.*)", CPUINFO.read_text(), re.M)
    limited = hasattr(os, "sched_getaffinity")
    return {
        "cpu": found[1] if found else platform.processor() or platform.machine(),
        "cores": len(os.sched_getaffinity(0)) if limited else os.cpu_count(),
        "gpu": torch.cuda.get_device_name() if torch and torch.cuda.is_available() else None,
        "system": platform.system(),
        "python": platform.python_version(),
        "torch": torch.__version__ if torch else version("torch"),
    }

"""Description of the machine."""

import os
import platform
import re
import sys
from importlib.metadata import version
from pathlib import Path
from typing import Any

CPUINFO = Path("/proc/cpuinfo")


def describe_machine() -> dict[str, Any]:
    """CPU, cores, GPU and versions, without personal data.

    No host name, user or path: results are published."""
    # Loading takes seconds; a stage without torch does not use the GPU.
    torch = sys.modules.get("torch")
    # Only Linux on x86 names its CPU there.
    model = CPUINFO.is_file() and re.search(r"^model name\s*: (.*)", CPUINFO.read_text(), re.M)
    return {
        "cpu": model[1] if model else platform.processor() or platform.machine(),
        "cores": len(os.sched_getaffinity(0))
        if hasattr(os, "sched_getaffinity")
        else os.cpu_count(),
        "gpu": torch.cuda.get_device_name() if torch and torch.cuda.is_available() else None,
        "system": platform.system(),
        "python": platform.python_version(),
        "torch": torch.__version__ if torch else version("torch"),
    }

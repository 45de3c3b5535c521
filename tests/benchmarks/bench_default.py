"""The README's first command, from a copy of the checkout without results."""

import subprocess
import sys
import tempfile
import time
from pathlib import Path

from measurement import Row

ROOT = Path(__file__).parents[2]
COMMAND = [sys.executable, "-m", "snakemake", "--cores", "2", "reports/table_4_3.csv"]


def rows() -> list[Row]:
    """Seconds that it takes, all stages, once."""
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder) / "checkout"
        subprocess.run(["git", "clone", "--quiet", ROOT, copy], check=True)
        started = time.perf_counter()
        subprocess.run(COMMAND, cwd=copy, check=True, capture_output=True)
        return [Row("default main job", "cpu x2", time.perf_counter() - started, "s")]

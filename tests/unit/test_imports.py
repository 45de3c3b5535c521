"""What the rules import; tests/workflow/test_style.py has the rooms' order."""

import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]


def test_the_graph_waits_for_nothing_that_computes():
    """Snakemake reads the rules at each start: with numba and trimesh that took 0.7 s longer."""
    common = (ROOT / "workflow/rules/common.smk").read_text(encoding="utf-8")
    imports = re.findall(r"^from neural_shadows.*$", common, re.MULTILINE)
    # `import scipy` alone loads none of its parts.
    parts = "'scipy.stats', 'scipy.ndimage', 'scipy.optimize', 'scipy.spatial'"
    heavy = f"{{*sys.modules}} & {{'numba', 'trimesh', 'torch', 'matplotlib', {parts}}}"
    code = "\n".join([*imports, "import sys", f"print({heavy})"])
    run = [sys.executable, "-c", code]
    said = subprocess.check_output(run, cwd=ROOT / "workflow", text=True)
    assert said.strip() == "set()"

"""What one takes along: `pip install .` brings all that a field needs, and little else."""

import ast
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

import neural_shadows
from neural_shadows.running.module_graph import modules_of

ROOT = Path(__file__).parents[2]
PUBLIC = ROOT / "workflow/neural_shadows/representations/shadow_field/shadow_field.py"
NAMES = {"PIL": "pillow"}  # of distributions that are called otherwise


def imported(path: Path) -> set[str]:
    """Top packages that a module imports, anywhere in it."""
    names = set()
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.Import):
            names |= {name.name for name in node.names}
        elif isinstance(node, ast.ImportFrom):
            names.add(node.module)
    return {name.partition(".")[0] for name in names}


def test_the_dependencies_are_what_a_field_imports():
    of_modules = {name for path in modules_of(PUBLIC) for name in imported(path)}
    others = of_modules - sys.stdlib_module_names - {"neural_shadows", "llvmlite"}  # numba's own
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    named = {re.match(r"[\w-]+", line)[0] for line in project["dependencies"]}
    assert {NAMES.get(name, name) for name in others} == named


def test_its_version_is_the_same_everywhere():
    """A release is refused where it is not, see .github/workflows/release.yaml."""
    version = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["version"]
    assert f"\nversion: {version}\n" in (ROOT / "CITATION.cff").read_text()
    latest = re.search(r"^## (.+), (.+)$", (ROOT / "CHANGELOG.md").read_text(), re.M)
    assert latest[1] == version
    assert f"\ndate-released: {latest[2]}\n" in (ROOT / "CITATION.cff").read_text()


def test_importing_it_loads_nothing_that_computes():
    """numpy alone: numba, trimesh and Embree come with the first fit."""
    heavy = "{'numba', 'trimesh', 'scipy', 'torch', 'embreex', 'safetensors', 'pydantic'}"
    code = f"import sys; from neural_shadows import ShadowField; print({heavy} & {{*sys.modules}})"
    run = [sys.executable, "-c", code]
    assert subprocess.check_output(run, cwd=ROOT / "workflow", text=True).strip() == "set()"


def test_other_names_are_unknown():
    with pytest.raises(AttributeError, match="no attribute 'ShadowFeld'"):
        neural_shadows.ShadowFeld  # noqa: B018
    assert {*neural_shadows.__all__} == neural_shadows._HOMES.keys()

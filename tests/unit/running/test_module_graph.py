"""A stage's modules are those that it needs: an edited plot must not retrain a network."""

import ast
from pathlib import Path

import pytest

from neural_shadows.running.module_graph import PACKAGE, modules_of

STAGES = sorted(
    path for path in PACKAGE.rglob("*.py") if "run_stage(snakemake" in path.read_text("utf-8")
)


def names_of(stage: str) -> set[str]:
    return {path.relative_to(PACKAGE).as_posix()[:-3] for path in modules_of(PACKAGE / stage)}


@pytest.mark.parametrize("stage", STAGES, ids=lambda path: path.stem)
def test_modules(stage):
    found = modules_of(stage)
    assert stage in found and found == sorted(set(found))
    assert PACKAGE / "running" / "stage.py" not in found
    # A stage knows nothing of the configuration: an edited description must not retrain.
    assert not {path.parent.name for path in found} & {"config", "layout"}
    for source in found:
        for node in ast.walk(ast.parse(source.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom):
                assert node.level == 0, f"{source}: relative imports are not followed"


def test_training_depends_on_what_decides_the_weights():
    names = names_of("training/train.py")
    assert {"training/training_run", "networks/weight_file", "rays/ray_set"} <= names
    rooms = {name.split("/")[0] for name in names}
    assert not rooms & {"reports", "metrics", "evaluation", "rendering", "meshes"}
    # A kind of network is an input of the trainings of that kind alone.
    kinds = {name for name in names if name.endswith("_network")}
    assert kinds == {"networks/object_space/shadow_network"}


def test_all_forms_of_import_are_followed(tmp_path):
    script = tmp_path / "script.py"
    script.write_text(
        "import json\n"
        "import neural_shadows.running.progress\n"
        "from neural_shadows import errors\n"
        "from neural_shadowsx.rays import shards\n"
        "def main():\n"
        "    import numpy, neural_shadows.running.hardware as h\n"
    )
    names = {path.stem for path in modules_of(script)}
    assert names == {"script", "progress", "errors", "hardware"}


def test_each_file_is_read_once(monkeypatch):
    """Snakemake asks for each of thousands of jobs: read anew, the thesis's graph took 46 s."""
    first = modules_of(PACKAGE / "evaluation" / "evaluate.py")
    monkeypatch.setattr(Path, "read_text", None)
    assert modules_of(PACKAGE / "evaluation" / "evaluate.py") == first

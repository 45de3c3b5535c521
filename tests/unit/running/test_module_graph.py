"""A script's modules are those that it needs: an edited plot must not retrain a network."""

import ast
from pathlib import Path

import pytest

from neural_shadows.config.networks import ENCODINGS
from neural_shadows.networks.kind_module import kind_module
from neural_shadows.running.module_graph import PACKAGE, modules_of

SCRIPTS = Path(__file__).parents[3] / "workflow" / "scripts"


def names_of(script: str) -> set[str]:
    return {path.stem for path in modules_of(SCRIPTS / f"{script}.py")}


@pytest.mark.parametrize("script", sorted(SCRIPTS.glob("*.py")), ids=lambda path: path.stem)
def test_paths(script):
    found = modules_of(script)
    assert found and found == sorted(set(found))
    assert all(path.is_file() and path.parent == PACKAGE for path in found)
    names = {path.stem for path in found}
    assert "errors" in names
    assert not names & {"jobs", "job_record", "rerun"}


@pytest.mark.parametrize("script", sorted(SCRIPTS.glob("*.py")), ids=lambda path: path.stem)
def test_imports_exist(script):
    """A module that is misspelt or missing would silently be no input."""
    for source in [script, *modules_of(script)]:
        for node in ast.walk(ast.parse(source.read_text())):
            if isinstance(node, ast.ImportFrom):
                assert node.level == 0, f"{source}: relative imports are not followed"
                if node.module and node.module.startswith("neural_shadows."):
                    path = PACKAGE / (node.module.split(".")[1] + ".py")
                    assert path.is_file(), f"{source}: {node.module}"


def test_training_depends_on_what_decides_the_weights():
    names = names_of("train")
    assert {"training", "shadow_network", "dead_zone_loss", "network_file", "ray_set"} <= names
    assert not names & {
        *("tables", "table_report", "strips", "preview", "wyrm", "metrics", "frames"),
        *("config", "layout", "shadow_query", "shadow_map", "evaluation", "published"),
        *("mesh", "ray_files", "view_directions", "ray_sampling", "light"),
        # A kind of network is an input of the trainings of that kind alone.
        *("frequency_network", "ray_grid_network", "occupancy_field_network"),
    }


def test_a_kind_of_network_is_found_by_its_name():
    for encoding in ENCODINGS:
        assert kind_module(encoding).is_file()
    names = {path.stem for path in modules_of(kind_module("hash_grid"))}
    assert {"ray_grid_network", "occupancy", "mesh"} <= names
    assert not names & {"frequency_network", "occupancy_field_network", "training"}


def test_rays_know_nothing_of_networks():
    for script in ("view_directions", "sample_rays", "label_rays", "prepare_mesh"):
        assert not names_of(script) & {"shadow_network", "training", "compute", "metrics"}, script


def test_tables_do_not_depend_on_training():
    names = names_of("write_table")
    assert "tables" in names
    assert not names & {"training", "shadow_network", "wyrm", "mesh", "ray_files"}


def test_what_jobs_does_around_a_call_is_no_input():
    """But for what stages use themselves: they write files, and count what they do."""
    around = modules_of(PACKAGE / "jobs.py")
    assert {"job_record", "rerun", "rates", "files"} <= {path.stem for path in around}
    assert {"files", "rates"} <= names_of("train")


def test_all_forms_of_import_are_followed(tmp_path):
    script = tmp_path / "script.py"
    script.write_text(
        "import json\n"
        "import neural_shadows.light\n"
        "from neural_shadows import published\n"
        "from neural_shadows.statistics import nothing\n"
        "def main():\n"
        "    import numpy, neural_shadows.hardware as h\n"
    )
    # by others: errors, csv_file
    expected = {"light", "published", "statistics", "hardware", "errors", "csv_file"}
    assert {path.stem for path in modules_of(script)} == expected


def test_each_file_is_read_once(monkeypatch):
    """Snakemake asks for each of thousands of jobs: read anew, the thesis's graph took 46 s."""
    modules_of(SCRIPTS / "evaluate.py")
    monkeypatch.setattr("neural_shadows.running.module_graph.ast", None)
    assert names_of("evaluate") > {"evaluation", "metrics"}


def test_no_import_no_modules(tmp_path):
    script = tmp_path / "script.py"
    script.write_text("import numpy\nfrom neural_shadowsx.light import draw_light\n")
    assert modules_of(script) == []

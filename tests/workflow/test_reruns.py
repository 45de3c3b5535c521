"""What an edit reruns: what depends on it, and nothing else."""

import os

import pytest
from checkout import SMOKE, write_overlay

# The stages that a scene's seed reaches, and what the page takes from them.
SEEDED = {
    "view_directions",
    "sample_rays",
    "label_rays",
    "describe_rays",
    "train",
    "evaluate",
    "table",
    "html_report",
}
# Those that only the shipped scenes have.
SEEDED_FIGURES = {"method_figure", "picture_strip", "loss_figure", "width_figure"}
SEEDED_TABLES = {
    *("frame_times", "performance_table", "memory_table", "claims"),
    *("find_depth_biases", "networks_table", "fronts_figure", "field_slice"),
}

# What shows the networks' pictures.
SHOWN = {
    *("picture_strip", "table", "performance_table", "width_figure", "claims", "html_report"),
    *("networks_table", "fronts_figure"),
}
TRAINED = SHOWN | {
    *("evaluate", "frame_times", "memory_table", "loss_figure"),
    *("find_depth_biases", "field_slice"),
}


@pytest.mark.parametrize(
    ("module", "rules"),
    [
        ("tables.py", SHOWN | {"memory_table"}),
        ("claims.py", {"claims", "html_report"}),
        # The table asks for the preview, so that one target makes all that belongs to it.
        ("preview.py", {"preview_scene", "table", "html_report"}),
        ("shadow_map.py", SHOWN | {"evaluate", "frame_times", "memory_table", "find_depth_biases"}),
        ("training.py", TRAINED | {"train"}),
        ("jobs.py", set()),
    ],
)
def test_edited_module(finished, module, rules):
    with finished.module(module).open("a") as file:
        file.write("\nEDITED = True\n")
    assert set(finished.pending().values()) == rules


@pytest.mark.parametrize(
    ("module", "trained"),
    [("occupancy_field_network.py", "field"), ("hash_grid_network.py", "hash_grid")],
)
def test_edited_kind_of_network(finished, module, trained):
    """Only networks of that kind are trained again; adding one trains none of the others."""
    with finished.module(module).open("a") as file:
        file.write("\nEDITED = True\n")
    networks = [path for path, rule in finished.pending().items() if rule == "train"]
    assert networks and all(trained in path for path in networks)


@pytest.mark.parametrize(
    ("edit", "rules"),
    [
        ({"tables": {"table_4_3": {"title": "Another title"}}}, {"table", "html_report"}),
        ({"evaluations": {"dragon": {"depth_bias": 0.01}}}, SHOWN | {"evaluate"}),
        ({"trainings": {"base": {"learning_rate": 0.002}}}, TRAINED - {"field_slice"} | {"train"}),
    ],
    ids=["title", "depth_bias", "learning_rate"],
)
def test_edited_value(finished, tmp_path, edit, rules):
    overlay = write_overlay(tmp_path / "edit.yaml", **edit)
    assert set(finished.pending(overlays=[overlay]).values()) == rules


def test_touched_modules_and_an_edited_comment(finished):
    for path in finished.folder.glob("workflow/neural_shadows/*.py"):
        os.utime(path)
    with (finished.folder / SMOKE).open("a") as file:
        file.write("\n# a comment\n")
    assert finished.pending() == {}


@pytest.mark.parametrize(
    ("edited", "others", "rules"),
    [
        ("dragon", ("torus", "/fence"), SEEDED | SEEDED_FIGURES | SEEDED_TABLES),
        ("torus", ("dragon", "fence", "table_4", "figure"), SEEDED),
    ],
)
def test_seed_of_one_scene(second_scene, tmp_path, edited, others, rules):
    overlay = write_overlay(tmp_path / "seed.yaml", scenes={edited: {"seed": 7}})
    pending = second_scene.checkout.pending(overlays=[second_scene.overlay, overlay])
    assert set(pending.values()) == rules
    for path in pending:
        assert not any(other in path for other in others), path


def test_truncated_metrics_are_named_and_made_again(finished):
    metrics = finished.results / "evaluations" / "dragon_sampling" / "shadow.000.csv"
    whole = metrics.read_bytes()
    metrics.write_bytes(whole[: len(whole) // 2])
    failed = finished.snakemake("reports/smoke/table_4_1.csv", "--forcerun", "table")
    assert failed.returncode != 0
    name = metrics.relative_to(finished.folder)
    (line,) = {line for line in failed.stdout.splitlines() if line.startswith("table: ")}
    assert f"{name}: " in line
    assert "moved to shadow.000.csv.broken, run again" in line
    finished.run("reports/smoke/table_4_1.csv")
    assert metrics.read_bytes() == whole

"""What an edit reruns: what depends on it, and nothing else."""

import os

import pytest
from checkout import SMOKE, write_overlay

# The stages that a scene's seed reaches.
SEEDED = {
    "view_directions",
    "sample_rays",
    "label_rays",
    "describe_rays",
    "train",
    "evaluate",
    "picture_strip",
    "table",
}


@pytest.mark.parametrize(
    ("module", "rules"),
    [
        ("tables.py", {"picture_strip", "table"}),
        ("strips.py", {"picture_strip", "table"}),
        # The table asks for the preview, so that one target makes all that belongs to it.
        ("preview.py", {"preview_scene", "table"}),
        ("shadow_map.py", {"evaluate", "picture_strip", "table"}),
        ("training.py", {"train", "evaluate", "picture_strip", "table"}),
    ],
)
def test_edited_module(finished, module, rules):
    with finished.module(module).open("a") as file:
        file.write("\nEDITED = True\n")
    assert set(finished.pending().values()) == rules


@pytest.mark.parametrize(
    ("edit", "rules"),
    [
        ({"tables": {"table_4_3": {"title": "Another title"}}}, {"table"}),
        ({"evaluations": {"dragon": {"depth_bias": 0.01}}}, {"evaluate", "picture_strip", "table"}),
        (
            {"trainings": {"base": {"learning_rate": 0.002}}},
            {"train", "evaluate", "picture_strip", "table"},
        ),
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


@pytest.mark.parametrize(("edited", "other"), [("dragon", "torus"), ("torus", "dragon")])
def test_seed_of_one_scene(second_scene, tmp_path, edited, other):
    overlay = write_overlay(tmp_path / "seed.yaml", scenes={edited: {"seed": 7}})
    pending = second_scene.checkout.pending(overlays=[second_scene.overlay, overlay])
    assert set(pending.values()) == SEEDED
    names = {
        "dragon": ("dragon", "table_4_1", "table_4_2", "table_4_3", "figure_4_4", "figure_4_5"),
        "torus": ("torus",),
    }
    for path in pending:
        assert any(name in path for name in names[edited]), path
        assert not any(name in path for name in names[other]), path

"""What an edit reruns: what depends on it, and nothing else."""

import os

import pytest
from checkout import SMOKE, write_overlay

# What shows the networks' pictures, and all that is made of a network.
SHOWN = {"table", "figure", "claims", "page"}
ANSWERED = SHOWN | {"query_network", "evaluate"}
TRAINED = ANSWERED | {"tune", "time_methods"}
MAPPED = SHOWN | {"tune", "evaluate", "time_methods"}  # of the methods by maps


@pytest.mark.parametrize(
    ("module", "rules"),
    [
        # Figures of a table import its settings.
        ("reports/tables/comparison.py", {"table", "figure", "page"}),
        ("reports/claims/write_claims.py", {"claims", "page"}),
        # The table asks for the preview, so that one target makes all that belongs to it.
        ("reports/drawing/preview.py", {"preview_scene", "table", "page"}),
        ("evaluation/evaluate.py", SHOWN | {"evaluate"}),
        ("evaluation/query_network.py", ANSWERED),
        ("shadow_maps/shadow_map.py", MAPPED),
        ("evaluation/methods/shadow_map.py", MAPPED),
        ("training/training_run.py", TRAINED | {"train", "viewer"}),
        ("metrics/kinds/flip.py", SHOWN | {"evaluate"}),
        ("running/stage.py", set()),
    ],
)
def test_edited_module(finished, module, rules):
    with finished.module(module).open("a") as file:
        file.write("\nEDITED = True\n")
    assert set(finished.pending().values()) == rules


def test_edited_kind_of_network(finished):
    """Only networks of that kind are trained again; adding one trains none of the others."""
    with finished.module("networks/object_space/hash_grid_network.py").open("a") as file:
        file.write("\nEDITED = True\n")
    networks = [path for path, rule in finished.pending().items() if rule == "train"]
    assert networks and all("hash_grid" in path for path in networks)


def test_edited_form_of_network(finished):
    """Of networks of whole frames likewise, and of methods only these are measured again."""
    with finished.module("networks/screen_space/kernel_unet.py").open("a") as file:
        file.write("\nEDITED = True\n")
    pending = finished.pending().items()
    for rule in ("train", "evaluate"):
        paths = [path for path, name in pending if name == rule]
        assert paths and all("kpnsm" in path for path in paths)


def test_edited_soft_method(finished):
    """It alone is measured again, and all methods of its tables are timed, for they take turns."""
    with finished.module("evaluation/methods/pcss.py").open("a") as file:
        file.write("\nEDITED = True\n")
    pending = finished.pending()
    measured = [path for path, rule in pending.items() if rule in ("tune", "evaluate")]
    assert measured and all("/all/pcss." in path for path in measured)
    assert set(pending.values()) == MAPPED


@pytest.mark.parametrize(
    ("edit", "rules"),
    [
        ({"tables": {"table_4_3": {"title": "Another title"}}}, {"table", "page"}),
        ({"experiments": {"dragon": {"bias": 0.01}}}, ANSWERED),
        ({"experiments": {"dragon": {"label": "Another"}}}, SHOWN),
        ({"trainings": {"base": {"learning_rate": 0.002}}}, TRAINED | {"train", "viewer"}),
    ],
    ids=["title", "bias", "label", "learning_rate"],
)
def test_edited_value(finished, tmp_path, edit, rules):
    overlay = write_overlay(tmp_path / "edit.yaml", **edit)
    assert set(finished.pending(overlays=[overlay]).values()) == rules


def test_touched_modules_and_an_edited_comment(finished):
    for path in finished.folder.glob("workflow/neural_shadows/*/*.py"):
        os.utime(path)
    with (finished.folder / SMOKE).open("a") as file:
        file.write("\n# a comment\n")
    assert finished.pending() == {}

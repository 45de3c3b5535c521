"""What an edit reruns: what depends on it, and nothing else."""

import pytest
from checkout import SMOKE, Checkout, write_overlay

# What shows the networks' pictures, and all that is made of a network.
SHOWN = {"table", "figure", "claims", "page", "manifest"}
TRAINED = SHOWN | {"evaluate", "count_violations", "tune", "time_methods"}
MAPPED = SHOWN | {"tune", "evaluate", "time_methods"}  # of the methods by maps


@pytest.fixture(scope="module")
def edited(smoke, tmp_path_factory) -> Checkout:
    """A copy of the finished smoke run whose modules tests edit for the time of a plan."""
    return smoke.copy(tmp_path_factory.mktemp("edited") / "checkout")


def pending_after(checkout: Checkout, *modules: str) -> dict[str, str]:
    """What edits of modules rerun: rule by output file. The modules are left as they were."""
    contents = {checkout.module(name): checkout.module(name).read_bytes() for name in modules}
    try:
        for path, content in contents.items():
            path.write_bytes(content + b"\nEDITED = True\n")
        return checkout.pending()
    finally:
        for path, content in contents.items():
            path.write_bytes(content)


# Those of one line together: tests/unit/running/test_module_graph.py takes them apart.
@pytest.mark.parametrize(
    ("modules", "rules"),
    [
        # Figures of a table import its settings. The table asks for the preview, so that one target
        # makes all that belongs to it.
        (
            ["reports/tables/comparison.py", "reports/claims/write_claims.py"]
            + ["reports/drawing/preview.py"],
            SHOWN | {"preview_scene"},
        ),
        (["evaluation/evaluate.py", "metrics/kinds/flip.py"], SHOWN | {"evaluate"}),
        (["evaluation/count_violations.py"], {"count_violations", "claims", "page", "manifest"}),
        (["shadow_maps/shadow_map.py"], MAPPED),
        (["training/training_run.py"], TRAINED | {"train", "viewer"}),
    ],
    ids=lambda value: value[0] if isinstance(value, list) else None,
)
def test_edited_modules(edited, modules, rules):
    assert set(pending_after(edited, *modules).values()) == rules


def test_edited_kinds(edited):
    """Only networks of a kind or form are trained again, and of soft methods it alone is measured.

    All methods of its tables are timed, for they take turns. Adding a kind trains none of the others.
    """
    kinds = {
        "hash_grid": "networks/object_space/hash_grid_network.py",
        "kpnsm": "networks/screen_space/kernel_unet.py",
        "/all/pcss.": "evaluation/methods/pcss.py",
    }
    pending = pending_after(edited, *kinds.values())
    for rule, expected in {
        "train": {"hash_grid", "kpnsm"},
        "evaluate": {*kinds},
        "tune": {"/all/pcss."},
    }.items():
        paths = [path for path, name in pending.items() if name == rule]
        assert all(any(kind in path for kind in kinds) for path in paths), (rule, paths)
        assert all(any(kind in path for path in paths) for kind in expected), (rule, paths)
    rules = TRAINED - {"count_violations"} | {"train", "viewer"}
    assert {*pending.values()} - {"profile_screen_network"} == rules


@pytest.mark.parametrize(
    ("edit", "rules"),
    [
        ({"tables": {"table_4_3": {"title": "Another title"}}}, {"table", "page", "manifest"}),
        ({"experiments": {"dragon": {"bias": 0.01}}}, SHOWN | {"evaluate", "count_violations"}),
        ({"experiments": {"dragon": {"label": "Another"}}}, SHOWN),
        # Of the thesis's networks, whose biases are none.
        ({"trainings": {"base": {"learning_rate": 0.002}}}, TRAINED - {"tune"} | {"train"}),
    ],
    ids=["title", "bias", "label", "learning_rate"],
)
def test_edited_value(edited, tmp_path, edit, rules):
    overlay = write_overlay(tmp_path / "edit.yaml", **edit)
    assert set(edited.pending(overlays=[overlay]).values()) == rules


def test_a_second_run_does_nothing(edited):
    """Nor one of modules of other comments and docstrings, or of another log."""
    for path in edited.folder.glob("workflow/neural_shadows/*/*.py"):
        text = path.read_text("utf-8").replace('"""', '"""Words. ', 1)
        path.write_text(f"# words\n{text}# words\n", "utf-8")
    for path in (edited.folder / SMOKE, edited.module("running/stage.py")):
        with path.open("a") as file:
            file.write("\n# a comment\n")
    said = edited.run()
    assert "Nothing to be done" in said and "Execute" not in said

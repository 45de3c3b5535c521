"""The shader to take along is the viewer's own; tests/browser runs it."""

from pathlib import Path

WORKFLOW = Path(__file__).parents[2] / "workflow"
PARTS = ("unit_sphere", "field_values", "field")


def test_it_is_the_viewer_s_files_joined():
    """After an edit of these: head -n N … > it, with its first lines, and the files behind them."""
    folder = WORKFLOW / "report/viewer/shaders"
    parts = "".join((folder / f"{name}.glsl").read_text("utf-8") for name in PARTS)
    head, _, joined = (WORKFLOW / "field/shadow_field.glsl").read_text("utf-8").partition("\n\n")
    assert joined == parts
    assert all(line.startswith("//") for line in head.splitlines())

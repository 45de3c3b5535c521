"""The examples of workflow/field/README.md, as a user types them, one after the other."""

import contextlib
import io
import re
from pathlib import Path

import numpy as np
import pytest
from shapes import bumpy_sphere

PAGE = (Path(__file__).parents[2] / "workflow/field/README.md").read_text("utf-8")


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """What the page's blocks leave and print, run in a folder with a mesh."""
    folder = tmp_path_factory.mktemp("page")
    bumpy_sphere(4).export(folder / "statue.obj")
    printed, names = io.StringIO(), {}
    with contextlib.chdir(folder), contextlib.redirect_stdout(printed):
        for block in re.findall(r"^```python\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL):
            exec(block, names)  # noqa: S102
    return names, printed.getvalue().splitlines()


def test_points_are_answered(run):
    names, _ = run
    for name in ("dark", "lit", "behind", "hit"):
        assert names[name].dtype == bool and 0 < names[name].mean() < 1, name
    assert names["visible"].min() == 0 and names["visible"].max() == 1


def test_hours_and_sky_of_a_bumpy_ball(run):
    names, _ = run
    hours, sky_view, normals = names["hours"], names["sky_view"], names["normals"]
    assert 6 < hours.max() < 12.01 and hours.min() == 0
    up = normals @ [0.0, 1.0, 0.0]
    # An open slope sees (1 + cos) / 2 of the sky's light; bumps hide some.
    assert np.all(sky_view < (1 + up) / 2 + 0.02)
    assert sky_view[up > 0.99].mean() > 0.9 and sky_view[up < -0.99].max() < 0.01


def test_each_mistake_is_one_line(run):
    _, printed = run
    assert len(printed) == 5  # the first is of a field's sizes
    for line, word in zip(printed[1:], ("not finite", "no direction", "no_such.obj", "statue.obj")):
        assert word in line

"""Errors beside the exact shadow at pixels' centres, of answers whose edges are known."""

import numpy as np
import pytest
import report_samples as samples
from screen_frames import edge, write_frames

from neural_shadows.evaluation.answers import name_of, write_answers
from neural_shadows.frames.frame_set import FrameSetPart
from neural_shadows.reports.tables import centre_errors

PLACES = {"exact_centre": 25, "mine": 27}  # of the edge, in pixels; the target's is another


def test_an_error_beside_the_centre_counts_no_antialiasing(tmp_path):
    """Two pixels of an edge from the centre's answer, in each scene that counts."""
    parts = [write_frames(tmp_path / "wall" / scene, "test") for scene in ("room", "tree", "attic")]
    paths = []
    for method, place in PLACES.items():
        paths.append(tmp_path / f"{method}.npz")
        moved = {
            part: place + 5 * (part.parent.name == "attic") for part in parts
        }  # is not measured
        answers = {name_of(part, k): edge(moved[part], soft=0.0) for part in parts for k in (0, 1)}
        write_answers(paths[-1], answers)
    labels = {method: method.capitalize() for method in PLACES}
    files = {"first_parts": parts, "soft_answers": paths}
    data, md = samples.written_table(
        centre_errors.table, tmp_path, labels=labels, measured=["room", "tree"], **files
    )
    table = data.set_index(["method", "number"])
    opened = FrameSetPart(parts[0])
    smooth = opened.valid[0, 0]
    centre, mine = (edge(place, soft=0.0) for place in PLACES.values())
    for k in (0, 1):
        assert table.loc[("exact_centre", k), "centre_off_edges"] == 0
        expected = np.square(mine - centre)[smooth].mean()
        assert table.loc[("mine", k), "centre_off_edges"] == pytest.approx(expected, rel=1e-5)
        expected = np.square(mine - opened.targets[0, k])[smooth].mean()
        assert expected > 0
        assert table.loc[("mine", k), "mse_off_edges"] == pytest.approx(expected, rel=1e-2)
    assert "First test frames of room, tree" in md.read_text(encoding="utf-8")

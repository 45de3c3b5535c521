"""Widths of penumbrae of a frame set, and what tables say of them."""

import json

import numpy as np
from screen_frames import write_frames

from neural_shadows.evaluation.measure_frames import measure_frames
from neural_shadows.reports.data.soft_frames import SoftFrames


def test_the_width_of_one_straight_edge(tmp_path):
    """Eight pixels of a ramp: as a light's penumbra as steep, 4 / π of that; a point light has none."""
    part = write_frames(tmp_path / "room", "test", count=2, twins=0)
    out = tmp_path / "widths.json"
    measure_frames([part], [], out, measure="widths.json")
    point, soft = json.loads(out.read_text())["scenes"]["room"]
    assert point is None
    assert np.allclose(soft, 8 * 4 / np.pi, rtol=0.2)
    shown = {"soft_metrics": [], "screen_trainings": [], "labels": {}, "frames_json": part}
    (note,) = SoftFrames(**shown, widths_json=out).describe_widths()
    assert (
        "of 1 scenes the median (least to most): light of 0.25 m radius 10 (10 to 10) and 10."
        in note
    )
    assert SoftFrames(**shown).describe_widths() == []

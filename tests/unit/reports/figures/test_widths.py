import pandas as pd
import pytest

from neural_shadows.errors import InputError
from neural_shadows.reports.figures.widths import width_figure, write_width_figure

TABLE = pd.DataFrame(
    {
        "method": ["D 64", "D 256", "L 64", "L 256", "ray traced"],
        "scene": ["dragon", "dragon", "landscape", "landscape", "dragon"],
        "frame_ms": [10.0, 30.0, 11.0, 31.0, 5.0],
        "frame_ms_q1": [9.0, 29.0, 10.0, 30.0, 4.0],
        "frame_ms_q3": [12.0, 33.0, 13.0, 34.0, 6.0],
        "lpips": [0.09, 0.04, 0.03, 0.02, float("nan")],
        "lpips_low": [0.08, 0.03, 0.02, 0.01, float("nan")],
        "lpips_high": [0.10, 0.05, 0.04, 0.03, float("nan")],
        "thesis_frame_ms": [11.5, 29.1, 13.2, 32.8, float("nan")],
        "thesis_lpips": [0.0894, 0.0379, 0.0279, 0.021, float("nan")],
    }
)
WIDTHS = {"D 256": 256, "D 64": 64, "L 64": 64, "L 256": 256}


def test_lines_of_each_scene_over_width():
    figure = width_figure(TABLE, WIDTHS, title="Widths")
    quality, speed = figure.axes
    ours = [line.lines[0] for line in quality.containers]
    assert [line.get_xdata().tolist() for line in ours] == [[64, 256], [64, 256]]
    assert [line.get_ydata().tolist() for line in ours] == [[0.09, 0.04], [0.03, 0.02]]
    dashed = [line for line in speed.lines if line.get_linestyle() == "--"]
    assert [line.get_ydata().tolist() for line in dashed] == [[11.5, 29.1], [13.2, 32.8]]


def test_missing_table_is_named(tmp_path):
    with pytest.raises(InputError, match=r"t\.csv: no such file; run"):
        write_width_figure(
            tmp_path / "t.csv",
            tmp_path / "a.png",
            tmp_path / "a.svg",
            title="",
            rows=[],
            widths={},
            scale="x",
        )

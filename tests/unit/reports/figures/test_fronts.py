import numpy as np
import pandas as pd
import pytest

from neural_shadows.errors import InputError
from neural_shadows.reports.figures.fronts import (
    front,
    fronts_figure,
    kind_of,
    read_networks,
    write_fronts_figure,
)

NAN = float("nan")
TABLE = pd.DataFrame(
    {
        "scene": "dragon",
        "method": ["Ray traced", "512²", "256²", "Field", "Thesis"],
        "encoding": [None, None, None, "occupancy_field", "frequency"],
        "lpips": [NAN, 0.01, 0.02, 0.005, 0.09],
        "lpips_low": [NAN, 0.009, 0.018, 0.004, 0.08],
        "lpips_high": [NAN, 0.012, 0.022, 0.006, 0.10],
        "flip": [NAN, 0.1, 0.2, 0.05, 0.9],
        "flip_low": [NAN, 0.09, 0.18, 0.04, 0.8],
        "flip_high": [NAN, 0.12, 0.22, 0.06, 1.0],
        "bytes": [NAN, 2.0**20, 2.0**18, 7e5, 2e6],
        "frame_ms": [5.0, 60.0, 20.0, 30.0, 900.0],
        "training_seconds": [NAN, NAN, NAN, 20.0, 300.0],
    }
)
KINDS = ["ray traced", "shadow map", "shadow map", "occupancy_field", "frequency"]
ROWS = [
    {"method": "ray_traced", "label": "Ray traced"},
    {"method": "shadow_map_512", "label": "512²"},
    {"method": "shadow_map_256", "label": "256²"},
    {"method": "field_biased", "label": "Field"},
    {"method": "dragon", "label": "Thesis"},
]


def test_front_is_what_nothing_else_undercuts():
    rng = np.random.default_rng(0)
    cost, error = rng.integers(0, 12, (2, 40)).astype(float)
    expected = {
        i
        for i in range(40)
        if not any(
            cost[j] <= cost[i]
            and error[j] <= error[i]
            and (cost[j], error[j]) != (cost[i], error[i])
            for j in range(40)
        )
    }
    found = front(cost, error)
    assert {(cost[i], error[i]) for i in found} == {(cost[i], error[i]) for i in expected}
    assert (np.diff(cost[found]) > 0).all() and (np.diff(error[found]) < 0).all()


def test_kinds():
    assert kind_of("ray_traced", "") == "ray traced"
    assert kind_of("shadow_map_512", NAN) == "shadow map"
    assert kind_of("fence_biased", "frequency") == "frequency"


def test_panels_show_what_has_a_cost_and_name_the_front():
    figure = fronts_figure(TABLE, KINDS, "lpips", title="Dragon")
    by_bytes, by_time, by_training = figure.axes
    assert [len(axes.containers) for axes in figure.axes] == [4, 4, 2]
    named = [[text.get_text() for text in axes.texts] for axes in figure.axes]
    assert named[0] == ["256²", "Field"]
    assert named[1] == ["ray traced: 0", "256²", "Field"]
    # A map is a line to come below where it has no training to show.
    assert named[2] == ["512²", "256²", "Field"]
    for axes in figure.axes:
        assert axes.get_xscale() == axes.get_yscale() == "log"


def test_flip_stands_in_for_lpips(tmp_path):
    TABLE.assign(lpips=NAN, lpips_low=NAN, lpips_high=NAN).to_csv(tmp_path / "t.csv", index=False)
    write_fronts_figure(
        tmp_path / "t.csv",
        tmp_path / "a.png",
        tmp_path / "a.svg",
        title="Dragon",
        scene="dragon",
        rows=ROWS,
        scale="test",
    )
    assert (tmp_path / "a.png").stat().st_size > 10_000
    assert "FLIP, mean" in (tmp_path / "a.svg").read_text(encoding="utf-8")


@pytest.mark.parametrize("content", [None, "", "scene,method\nfence,a\n"])
def test_a_table_without_the_rows_is_named(tmp_path, content):
    if content is not None:
        (tmp_path / "t.csv").write_text(content)
    with pytest.raises(InputError, match=r"t\.csv: (no such file|not a whole table)"):
        write_fronts_figure(
            tmp_path / "t.csv",
            tmp_path / "a.png",
            tmp_path / "a.svg",
            title="",
            scene="dragon",
            rows=ROWS,
            scale="",
        )


def test_a_row_that_is_missing_is_named(tmp_path):
    TABLE.iloc[:-1].to_csv(tmp_path / "t.csv", index=False)
    with pytest.raises(InputError, match=rf"t\.csv: has no row '{ROWS[-1]['label']}' of dragon"):
        read_networks(tmp_path / "t.csv", "dragon", [row["label"] for row in ROWS])

import json

import numpy as np
import pandas as pd
import pytest
from sample_records import FRAME_TIMES

from neural_shadows.errors import InputError
from neural_shadows.evaluation.frame_times import read_frame_times
from neural_shadows.reports.published import read_published
from neural_shadows.reports.tables.frame_times import performance_table

PUBLISHED = read_published("config/published.csv")
ROWS = [
    {"method": "dragon", "label": "Dragon, 256", "published": "dragon_256"},
    {"method": "dragon_64", "label": "Dragon, 64", "published": None},
    {"method": "ray_traced", "label": "ray traced", "published": None},
    {"method": "shadow_map_512", "label": "512²", "published": None},
]
TIMES = {
    "dragon": {
        "methods": {
            "dragon": {"ms": [10.0, 30.0, 20.0, 50.0, 40.0]},
            "dragon_64": {"ms": [5.0]},
            "ray_traced": {"ms": [1.0, 2.0]},
            "shadow_map_512": {"ms": [3.0, 3.0]},
        }
    }
}
METRICS = pd.DataFrame(
    [
        (view, "surface", method, metric, value + view / 100)
        for view in range(2)
        for method, value in (("dragon", 0.1), ("dragon_64", 0.2), ("shadow_map_512", 0.3))
        for metric in ("lpips", "psnr")
    ],
    columns=["view", "view_set", "method", "metric", "value"],
)


def table(rows=ROWS):
    return performance_table(
        rows,
        ["dragon"] * len(rows),
        TIMES,
        {"dragon": METRICS},
        {"dragon": 2_227_200, "dragon_64": 163_584},
        "4.6",
        PUBLISHED,
        seed=1,
    ).set_index("method")


def test_median_quartiles_lpips_and_size_beside_the_thesis():
    row = table().loc["Dragon, 256"]
    assert (row["frame_ms_q1"], row["frame_ms"], row["frame_ms_q3"]) == (20, 30, 40)
    assert row["repeats"] == 5
    assert row["lpips"] == pytest.approx(0.105)
    assert row["lpips_low"] < row["lpips"] < row["lpips_high"]
    assert row["size_kib"] == 2175
    assert (row["thesis_frame_ms"], row["thesis_lpips"], row["thesis_size_kib"]) == (
        29.1,
        0.0379,
        2175,
    )
    assert row["frame_ms_minus_thesis"] == pytest.approx(30 - 29.1)
    assert row["size_kib_minus_thesis"] == 0


def test_baselines_have_what_applies_to_them():
    frame = table()
    assert frame.index.tolist() == [row["label"] for row in ROWS]
    assert np.isnan(frame.loc["ray traced", "lpips"])
    assert np.isnan(frame.loc["ray traced", "size_kib"])
    assert frame.loc["512²", "size_kib"] == 1024
    assert frame.loc["512²", "lpips"] == pytest.approx(0.305)
    assert np.isnan(frame.loc["512²", "thesis_frame_ms"])


def test_method_without_times_is_named():
    rows = [{"method": "fence", "label": "Fence", "published": None}]
    with pytest.raises(InputError, match="frame times of dragon: there are none of fence"):
        table(rows)


@pytest.mark.parametrize("text", ["", '{"scene": "dragon"}', "[1]"])
def test_times_cut_short_are_named(tmp_path, text):
    path = tmp_path / "dragon.json"
    path.write_text(text)
    with pytest.raises(
        InputError, match=r"dragon\.json: (not a whole JSON file|no file of frame times)"
    ):
        read_frame_times([path])


def test_times_are_read_by_scene(tmp_path):
    path = tmp_path / "x.json"
    path.write_text(json.dumps(FRAME_TIMES))
    assert list(read_frame_times([path])) == ["dragon"]

import numpy as np
import pandas as pd
import pytest

from neural_shadows.reports.tables.comparison import METRICS
from neural_shadows.reports.tables.networks import method_facts, networks_table, reading_columns

ROWS = [
    {"method": "ray_traced", "label": "Ray traced", "published": None},
    {"method": "shadow_map_512", "label": "512²", "published": None},
    {"method": "field_biased", "label": "Field", "published": None},
    {"method": "shadow_map_512", "label": "512²", "published": None},
]
SCENES = ["dragon", "dragon", "dragon", "fence"]
TIMES = {
    "methods": {
        "ray_traced": {"ms": [1.0, 2.0, 3.0]},
        "shadow_map_512": {"ms": [4.0]},
        "field_biased": {"ms": [5.0, 6.0, 7.0, 8.0, 9.0]},
    },
    "rays_per_second": {"field_biased": [1e6, 3e6, 2e6]},
}
RECORDS = {
    "field": {
        "network": {"encoding": "occupancy_field"},
        "parameters": 1000,
        "seconds": 12.5,
        "samples": 40_000,
    }
}
CONTEXT = {
    "mesh": "ball",
    "scale": "test",
    "width": 60,
    "height": 40,
    "lpips_net": "squeeze",
    "seed": 1,
}


def metrics(**values: float) -> pd.DataFrame:
    return pd.DataFrame(
        [
            (view, "surface", method, metric, value + view / 100)
            for view in range(3)
            for method, value in values.items()
            for metric in METRICS
        ],
        columns=["view", "view_set", "method", "metric", "value"],
    )


def facts(method: str) -> dict:
    return method_facts(method, TIMES, {"field_biased": 2048}, RECORDS, {"field_biased": 0.01})


@pytest.fixture
def table() -> pd.DataFrame:
    return networks_table(
        ROWS,
        SCENES,
        {
            "dragon": metrics(shadow_map_512=0.3, field_biased=0.1),
            "fence": metrics(shadow_map_512=0.5),
        },
        [facts(row["method"]) for row in ROWS],
        dict.fromkeys(["dragon", "fence"], CONTEXT),
        seed=1,
    )


def test_facts_of_a_network():
    assert facts("field_biased") == {
        "encoding": "occupancy_field",
        "bytes": 2048,
        "parameters": 1000,
        "training_seconds": 12.5,
        "samples": 40_000,
        "depth_bias": 0.01,
        "rays_per_second": 2e6,
        "frame_ms": 7,
        "frame_ms_q1": 6,
        "frame_ms_q3": 8,
    }


def test_maps_and_ray_tracing_have_what_applies_to_them():
    assert facts("shadow_map_512")["bytes"] == 2**20
    for method in ("shadow_map_512", "ray_traced"):
        found = facts(method)
        assert found["encoding"] == ""
        for name in ("parameters", "training_seconds", "samples", "depth_bias", "rays_per_second"):
            assert np.isnan(found[name])
    assert np.isnan(facts("ray_traced")["bytes"]) and facts("ray_traced")["frame_ms"] == 2


def test_rows_keep_their_order_and_scenes_their_own_values(table):
    assert list(zip(table["scene"], table["method"])) == [
        ("dragon", "Ray traced"),
        ("dragon", "512²"),
        ("dragon", "Field"),
        ("fence", "512²"),
    ]
    assert table["lpips"].tolist()[1:] == pytest.approx([0.31, 0.11, 0.51])
    assert np.isnan(table["psnr"][0])  # ray tracing is the reference
    assert table["bytes"].tolist()[1:] == [2**20, 2048, 2**20]
    assert (table["lpips_low"] <= table["lpips"])[1:].all()
    assert not [name for name in table if "thesis" in name]
    assert set(CONTEXT) <= set(table)


def test_cells_for_reading(table):
    columns = reading_columns(table)
    assert columns["LPIPS ↓"][0] == "" and columns["LPIPS ↓"][2].startswith("0.1100 [0.")
    assert columns["size KiB ↓"] == ["", "1,024", "2", "1,024"]
    assert columns["M rays/s ↑"] == ["", "", "2", ""]
    assert columns["bias"][2] == "0.01"
    assert columns["frame ms ↓"] == ["2", "4", "7", "4"]

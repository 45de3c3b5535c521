import pandas as pd
import pytest
from report_samples import (
    RUN,
    SCENES,
    all_metrics,
    cells_of,
    metrics_of,
    row,
    write_lpips,
    write_mesh,
    write_metrics,
    write_record,
)
from sample_records import FRAME_TIMES, TRAINING

from neural_shadows.reports.tables import networks

ROWS = [
    row("ray_traced", "Ray traced"),
    row("shadow_map_512", "512²"),
    row("field_biased", "Field", bias="held_out"),
    row("field", "Field, no bias"),
    row("shadow_map_512", "512²", scene="fence"),
]
MS = {
    "ray_traced": [1.0, 2.0, 3.0],
    "shadow_map_512": [4.0],
    "field_biased": [5.0, 6.0, 7.0, 8.0, 9.0],
    "field": [1.0],
}
MEANS = {
    "dragon": {"shadow_map_512": 0.3, "field_biased": 0.1, "field": 0.2},
    "fence": {"shadow_map_512": 0.5},
}


@pytest.fixture
def written(tmp_path, monkeypatch):
    monkeypatch.setattr(networks, "network_bytes", lambda path: 2048)
    csv, md = tmp_path / "n.csv", tmp_path / "n.md"
    times = {
        **FRAME_TIMES,
        "methods": {method: {"ms": ms} for method, ms in MS.items()},
        "rays_per_second": {"field_biased": [1e6, 3e6, 2e6], "field": [1e6]},
    }
    metrics = [
        path
        for scene, means in MEANS.items()
        for path in write_metrics(
            tmp_path, scene, metrics_of({name: all_metrics(mean) for name, mean in means.items()})
        )
    ]
    training = {**TRAINING, "name": "field", "network": {"encoding": "occupancy_field"}}
    networks.write(
        times=[
            write_record(tmp_path / f"frame_times/n/{scene}.json", {**times, "scene": scene})
            for scene in MEANS
        ],
        metrics=metrics,
        weights=[tmp_path / "networks/field/weights"],
        trainings=[write_record(tmp_path / "networks/field/training.json", training)],
        depth_biases=[write_record(tmp_path / "depth_biases/field.json", {"depth_bias": 0.01})],
        meshes=[write_mesh(tmp_path, scene) for scene in MEANS],
        lpips_json=write_lpips(tmp_path),
        csv=csv,
        md=md,
        title="Networks",
        rows=ROWS,
        run=RUN,
        scenes=SCENES,
    )
    return pd.read_csv(csv), md


def test_rows_keep_their_order_and_scenes_their_own_values(written):
    table, _ = written
    assert list(zip(table["scene"], table["method"])) == [(r["scene"], r["label"]) for r in ROWS]
    assert table["lpips"].tolist()[1:] == pytest.approx([0.3, 0.1, 0.2, 0.5])
    assert table["seed"].tolist()[1:] == [11, 11, 11, 12]
    assert (table["lpips_low"] <= table["lpips"])[1:].all()
    assert not [name for name in table if "thesis" in name]


def test_facts_of_networks(written):
    table, _ = written
    facts = table.loc[2, list(networks.FACTS)].to_dict()
    assert facts == {
        "encoding": "occupancy_field",
        "bytes": 2048,
        "parameters": 100,
        "training_seconds": 1.5,
        "samples": 640,
        "depth_bias": 0.01,
        "rays_per_second": 2e6,
        "frame_ms": 7,
        "frame_ms_q1": 6,
        "frame_ms_q3": 8,
    }
    assert (table["depth_bias"][3], table["rays_per_second"][3]) == (0, 1e6)


def test_maps_and_ray_tracing_have_what_applies_to_them(written):
    table, _ = written
    assert table["bytes"].tolist()[1:] == pytest.approx([2**20, 2048, 2048, 2**20], rel=1e-5)
    assert table.loc[[0, 1, 4], ["encoding", "parameters", "depth_bias"]].isna().all(axis=None)
    ray_traced = table.loc[0]
    assert ray_traced[["psnr", "bytes"]].isna().all()  # it is the reference
    assert ray_traced["frame_ms"] == 2


def test_cells_for_reading(written):
    _, md = written
    ray_traced, _, field = (cells_of(md, line) for line in (0, 1, 2))
    assert (ray_traced["LPIPS ↓"], ray_traced["size KiB ↓"]) == ("", "")
    assert field["LPIPS ↓"].startswith("0.1000 [0.")
    assert (field["size KiB ↓"], field["M rays/s ↑"], field["bias"]) == ("2", "2", "0.01")
    assert "Mesh of fence: fence (a procedural stand-in, not the thesis's mesh)" in md.read_text()

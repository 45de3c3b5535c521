import pytest
from report_samples import (
    all_metrics,
    cells_of,
    metrics_of,
    row,
    write_mesh,
    write_metrics,
    write_record,
    written_table,
)
from sample_records import FRAME_TIMES

from neural_shadows.reports.tables import networks, timed_quality

ROWS = [
    row("ray_traced", "Ray traced"),
    row("shadow_map_512", "512²"),
    row("dragon_biased", "Network", bias="held_out"),
    row("dragon", "Network, no bias"),
    row("shadow_map_512", "512²", scene="fence"),
]
MS = {
    "ray_traced": [1.0, 2.0, 3.0],
    "shadow_map_512": [4.0],
    "dragon_biased": [5.0, 6.0, 7.0, 8.0, 9.0],
    "dragon": [1.0],
}
MEANS = {
    "dragon": {"shadow_map_512": 0.3, "dragon_biased": 0.1, "dragon": 0.2},
    "fence": {"shadow_map_512": 0.5},
}


@pytest.fixture
def written(tmp_path, monkeypatch):
    monkeypatch.setattr(timed_quality, "network_bytes", lambda path: 2048)
    times = {
        **FRAME_TIMES,
        "methods": {method: {"ms": ms} for method, ms in MS.items()},
        "rays_per_second": {"dragon_biased": [1e6, 3e6, 2e6], "dragon": [1e6]},
    }
    metrics = {
        scene: metrics_of({method: all_metrics(mean) for method, mean in means.items()})
        for scene, means in MEANS.items()
    }
    return written_table(
        networks.write,
        tmp_path,
        times=[
            write_record(tmp_path / f"frame_times/n/{scene}.json", {**times, "scene": scene})
            for scene in MEANS
        ],
        metrics=[p for scene, v in metrics.items() for p in write_metrics(tmp_path, scene, v)],
        depth_biases=[write_record(tmp_path / "depth_biases/dragon.json", {"depth_bias": 0.01})],
        meshes=[write_mesh(tmp_path, scene) for scene in MEANS],
        rows=ROWS,
    )


def test_rows_keep_their_order_and_have_the_facts_of_their_kind(written):
    table, md = written
    assert list(zip(table["scene"], table["method"])) == [(r["scene"], r["label"]) for r in ROWS]
    assert table["lpips"].tolist()[1:] == pytest.approx([0.3, 0.1, 0.2, 0.5])
    assert table["seed"].tolist()[1:] == [11, 11, 11, 12]
    assert not [name for name in table if "thesis" in name]
    assert table.loc[2, list(networks.FACTS)].to_dict() == {
        "encoding": "frequency",
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
    # Maps and ray tracing have what applies to them.
    assert table["bytes"].tolist()[1:] == pytest.approx([2**20, 2048, 2048, 2**20], rel=1e-5)
    assert table.loc[[0, 1, 4], ["encoding", "parameters", "depth_bias"]].isna().all(axis=None)
    assert table.loc[0, ["psnr", "bytes"]].isna().all()  # it is the reference
    assert table["frame_ms"][0] == 2

    ray_traced, _, network = (cells_of(md, line) for line in (0, 1, 2))
    assert (ray_traced["LPIPS ↓"], ray_traced["size KiB ↓"]) == ("", "")
    assert network["LPIPS ↓"].startswith("0.1000 [0.")
    assert (network["size KiB ↓"], network["M rays/s ↑"], network["bias"]) == ("2", "2", "0.01")
    assert "Mesh of fence: fence (a procedural stand-in, not the thesis's mesh)" in md.read_text()

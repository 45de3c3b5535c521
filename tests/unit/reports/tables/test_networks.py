import pytest
import report_samples as samples

from neural_shadows.reports.tables.networks import FACTS, SPEEDS, write
from neural_shadows.reports.tables.quality import METRICS

ROWS = [
    samples.row("ray_traced", "Ray traced"),
    samples.row("shadow_map_512", "512²"),
    samples.row("dragon_biased", "Network", bias="held_out"),
    samples.row("dragon", "Network, no bias"),
    samples.row("shadow_map_512", "512²", scene="fence"),
]
MS = {"ray_traced": [1, 2, 3], "shadow_map_512": [4], "dragon_biased": [5, 9, 7, 8, 6]}
MEANS = {
    "dragon": {"shadow_map_512": 0.3, "dragon_biased": 0.1, "dragon": 0.2},
    "fence": {"shadow_map_512": 0.5},
}


def test_rows_keep_their_order_and_have_the_facts_of_their_kind(tmp_path):
    methods = {method: {"ms": ms} for method, ms in MS.items()} | {"dragon": {"ms": [1]}}
    speeds = {"dragon_biased": [1e6, 3e6, 2e6], "dragon": [1e6]}
    times, metrics = [], []
    for scene, means in MEANS.items():
        timed = {**samples.TIMES, "scene": scene, "methods": methods, "rays_per_second": speeds}
        times.append(samples.write_record(tmp_path / f"frame_times/{scene}.json", timed))
        means = {method: dict.fromkeys(METRICS, mean) for method, mean in means.items()}
        metrics.append(samples.write_metrics(tmp_path, means, scene))
    table, md = samples.written_table(
        write,
        tmp_path,
        times=times,
        metrics=metrics,
        depth_biases=[
            samples.write_record(tmp_path / "depth_biases/dragon.json", {"depth_bias": 0.01})
        ],
        meshes=[samples.write_mesh(tmp_path, scene) for scene in MEANS],
        rows=ROWS,
    )
    assert list(zip(table["scene"], table["method"])) == [(r["scene"], r["label"]) for r in ROWS]
    assert table["lpips"].tolist()[1:] == pytest.approx([0.3, 0.1, 0.2, 0.5])
    assert table["seed"].tolist()[1:] == [11, 11, 11, 12]
    facts = ["frequency", 2_227_200, 100, 1.5, 640, 0.01]
    assert table.loc[2, [*FACTS, *SPEEDS]].tolist() == [*facts, 2e6, 7, 6, 8]
    assert (table["depth_bias"][3], table["rays_per_second"][3]) == (0, 1e6)
    # Maps and ray tracing, which is the reference, have what applies to them.
    assert table["bytes"].tolist()[1:] == pytest.approx([2**20, 2_227_200, 2_227_200, 2**20], 1e-5)
    assert table.loc[[0, 1, 4], ["encoding", "parameters", "depth_bias"]].isna().all(axis=None)
    assert table.loc[0, ["psnr", "bytes"]].isna().all() and table["frame_ms"][0] == 2

    network = samples.cells_of(md, 2)
    assert network["LPIPS ↓"].startswith("0.1000 [0.")
    assert (network["size KiB ↓"], network["M rays/s ↑"], network["bias"]) == ("2,175", "2", "0.01")
    assert "Mesh of fence: fence (a procedural stand-in, not the thesis's mesh)" in md.read_text()

import pytest
import report_samples as samples

from neural_shadows.reports.tables.frame_times import write
from neural_shadows.reports.tables.quality import METRICS

ROWS = [
    samples.row("dragon", published="dragon_256"),
    samples.row("ray_traced"),
    samples.row("shadow_map_512"),
]
MS = {"dragon": [10, 30, 20, 50, 40], "ray_traced": [1, 2], "shadow_map_512": [3, 3]}


@pytest.mark.parametrize("thesis_mesh", [True, False])
def test_median_quartiles_lpips_and_size_beside_the_thesis(tmp_path, thesis_mesh):
    times = {**samples.TIMES, "methods": {method: {"ms": ms} for method, ms in MS.items()}}
    means = {"dragon": 0.1, "shadow_map_512": 0.3}
    means = {method: dict.fromkeys(METRICS, mean) for method, mean in means.items()}
    table, md = samples.written_table(
        write,
        tmp_path,
        times=[samples.write_record(tmp_path / "frame_times/t/dragon.json", times)],
        metrics=[samples.write_metrics(tmp_path, means)],
        meshes=[samples.write_mesh(tmp_path, thesis_mesh=thesis_mesh)],
        published="4.6",
        rows=ROWS,
    )
    ours, ray_traced, shadow_map = (part for _, part in table.iterrows())
    assert ours[["frame_ms_q1", "frame_ms", "frame_ms_q3", "repeats"]].tolist() == [20, 30, 40, 5]
    assert ours["lpips_low"] < ours["lpips"] < ours["lpips_high"]
    assert samples.cells_of(md, 0)["frame ms ↓"] == "30.0 [20.0, 40.0]"
    # Baselines have what applies to them.
    assert ray_traced[["lpips", "size_kib"]].isna().all()
    assert shadow_map[["lpips", "size_kib"]].tolist() == pytest.approx([0.3, 1024])
    assert samples.cells_of(md, 1)["LPIPS ↓"] == ""
    # Of another mesh the thesis says the network's size alone.
    assert (ours["thesis_size_kib"], ours["size_kib_minus_thesis"]) == (2175, 0)
    theirs = ours[["thesis_frame_ms", "thesis_lpips", "frame_ms_minus_thesis"]]
    if thesis_mesh:
        assert theirs.tolist() == pytest.approx([29.1, 0.0379, 30 - 29.1])
    else:
        assert theirs.isna().all()
    assert ("it did not measure the mesh wyrm" in md.read_text()) is not thesis_mesh

import pytest
import report_samples as samples

from neural_shadows.reports.data.quality import METRICS
from neural_shadows.reports.tables.frame_times import table as make_table

ROWS = [
    samples.row("dragon", published="dragon_256"),
    samples.row("ray_traced"),
    samples.row("shadow_map_512"),
    samples.row("no_shadow"),
]
MS = {"dragon": [10, 30, 20, 50, 40], "ray_traced": [1, 2], "shadow_map_512": [3, 3]}
MS |= {"no_shadow": [1, 1]}


@pytest.fixture
def written(tmp_path):
    def written(device="cpu", lpips=0.1, **mesh):
        methods = {method: samples.timed(ms, resident_bytes=1024) for method, ms in MS.items()}
        methods["dragon"]["device"] = device
        means = {"dragon": (lpips, 30), "shadow_map_512": (0.3, 35), "no_shadow": (0.4, 20)}
        means = {
            method: {name: low if name in ("lpips", "flip") else high for name in METRICS}
            for method, (low, high) in means.items()
        }
        machine = samples.MACHINE | {"gpu": "a GPU"}
        times = {**samples.TIMES, "machine": machine, "methods": methods}
        return samples.written_table(
            make_table,
            tmp_path,
            times=[samples.write_record(tmp_path / "frame_times/t/dragon.json", times)],
            metrics=[samples.write_metrics(tmp_path, means)],
            meshes=[samples.write_mesh(tmp_path, **mesh)],
            published="4.6",
            rows=ROWS,
        )

    return written


@pytest.mark.parametrize("thesis_mesh", [True, False])
def test_median_quartiles_lpips_and_size_beside_the_thesis(written, thesis_mesh):
    table, md = written(thesis_mesh=thesis_mesh)
    ours, ray_traced, shadow_map = (table.iloc[i] for i in range(3))
    assert ours[["frame_ms_q1", "frame_ms", "frame_ms_q3", "repeats"]].tolist() == [20, 30, 40, 5]
    assert ours[["own_ms", "device", "resident_kib"]].tolist() == [15, "cpu", 1]
    assert ours["lpips_low"] < ours["lpips"] < ours["lpips_high"]
    cells = samples.cells_of(md, 0)
    assert (cells["frame ms ↓"], cells["own ms ↓"]) == ("30.0 [20.0, 40.0]", "15.0 [10.0, 20.0]")
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


def test_a_network_that_has_not_learned_is_marked(written):
    assert "not learned" not in written(lpips=0.1)[1].read_text()
    table, md = written(lpips=0.4)
    assert not table["learned"][0] and table["learned"][1:].isna().all()
    assert samples.cells_of(md, 0)["method"] == "dragon (**not learned**)"


def test_times_of_two_devices_are_not_comparable(written):
    table, md = written(device="cuda")
    assert table["device"].tolist() == ["cuda", "cpu", "cpu", "cpu"]
    assert md.read_text().startswith("# Title: not comparable, on cpu and cuda (table 4.6")
    assert samples.cells_of(md, 1)["device"] == "cpu"

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

from neural_shadows.reports.tables import frame_times, timed_quality

ROWS = [
    row("dragon", "256 wide", published="dragon_256"),
    row("ray_traced", "Ray traced"),
    row("shadow_map_512", "512²"),
]
METHODS = {
    "dragon": {"ms": [10.0, 30.0, 20.0, 50.0, 40.0]},
    "ray_traced": {"ms": [1.0, 2.0]},
    "shadow_map_512": {"ms": [3.0, 3.0]},
}


@pytest.fixture
def write(tmp_path, monkeypatch):
    monkeypatch.setattr(timed_quality, "network_bytes", lambda path: 2_227_200)
    times = {**FRAME_TIMES, "methods": METHODS}
    metrics = metrics_of({"dragon": all_metrics(0.1), "shadow_map_512": all_metrics(0.3)})

    def write(thesis_mesh, published="4.6"):
        table, md = written_table(
            frame_times.write,
            tmp_path,
            times=[write_record(tmp_path / "frame_times/t/dragon.json", times)],
            metrics=write_metrics(tmp_path, "dragon", metrics),
            meshes=[write_mesh(tmp_path, thesis_mesh=thesis_mesh)],
            published=published,
            rows=ROWS,
        )
        return table.set_index("method"), md

    return write


def test_median_quartiles_lpips_and_size_beside_the_thesis(write):
    table, md = write(thesis_mesh=True)
    ours = table.loc["256 wide"]
    assert ours[["frame_ms_q1", "frame_ms", "frame_ms_q3", "repeats"]].tolist() == [20, 30, 40, 5]
    assert ours["lpips"] == pytest.approx(0.1)
    assert ours["lpips_low"] < ours["lpips"] < ours["lpips_high"]
    theirs = ours[["thesis_frame_ms", "thesis_lpips", "thesis_size_kib"]]
    assert theirs.tolist() == [29.1, 0.0379, 2175]
    assert ours["frame_ms_minus_thesis"] == pytest.approx(30 - 29.1)
    assert ours["size_kib_minus_thesis"] == 0
    assert cells_of(md, 0)["frame ms ↓"] == "30.0 [20.0, 40.0]"
    # Baselines have what applies to them.
    assert table.loc["Ray traced", ["lpips", "size_kib"]].isna().all()
    assert table.loc["512²", ["lpips", "size_kib"]].tolist() == pytest.approx([0.3, 1024])
    assert cells_of(md, 1)["LPIPS ↓"] == ""


def test_of_another_mesh_the_thesis_says_sizes_alone(write):
    table, md = write(thesis_mesh=False)
    ours = table.loc["256 wide"]
    assert ours[["thesis_frame_ms", "thesis_lpips", "frame_ms_minus_thesis"]].isna().all()
    assert ours["thesis_size_kib"] == 2175
    note = "*thesis*: sizes only for dragon; it did not measure the mesh wyrm."
    assert note in md.read_text()
    _, md = write(thesis_mesh=False, published=None)
    assert "thesis" not in md.read_text().replace("the thesis does not name", "")

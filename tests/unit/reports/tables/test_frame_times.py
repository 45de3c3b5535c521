import pandas as pd
import pytest
from report_samples import (
    PUBLISHED,
    RUN,
    cells_of,
    metrics_of,
    row,
    write_lpips,
    write_mesh,
    write_metrics,
    write_record,
)
from sample_records import FRAME_TIMES

from neural_shadows.reports.tables import frame_times

ROWS = [
    row("dragon", "256 wide", published="dragon_256"),
    row("ray_traced", "Ray traced"),
    row("shadow_map_512", "512²"),
    row("fence", "Fence", scene="fence"),
]
TIMES = {
    "dragon": {
        "dragon": {"ms": [10.0, 30.0, 20.0, 50.0, 40.0]},
        "ray_traced": {"ms": [1.0, 2.0]},
        "shadow_map_512": {"ms": [3.0, 3.0]},
    },
    "fence": {"fence": {"ms": [7.0]}},
}
LPIPS = {"dragon": {"dragon": 0.1, "shadow_map_512": 0.3}, "fence": {"fence": 0.2}}


@pytest.fixture
def written(tmp_path, monkeypatch):
    monkeypatch.setattr(frame_times, "network_bytes", lambda path: 2_227_200)

    def write_table(thesis_mesh):
        csv, md = tmp_path / "t.csv", tmp_path / "t.md"
        metrics = {
            scene: metrics_of({method: {"lpips": mean} for method, mean in means.items()})
            for scene, means in LPIPS.items()
        }
        frame_times.write(
            times=[
                write_record(
                    tmp_path / f"frame_times/t/{scene}.json",
                    {**FRAME_TIMES, "scene": scene, "methods": methods},
                )
                for scene, methods in TIMES.items()
            ],
            metrics=[p for s, frame in metrics.items() for p in write_metrics(tmp_path, s, frame)],
            weights=[tmp_path / f"networks/{name}/weights" for name in ("dragon", "fence")],
            meshes=[
                write_mesh(tmp_path, thesis_mesh=thesis_mesh),
                write_mesh(tmp_path, "fence", thesis_mesh=True),
            ],
            lpips_json=write_lpips(tmp_path),
            published_csv=PUBLISHED,
            csv=csv,
            md=md,
            title="Times",
            published="4.6",
            rows=ROWS,
            run=RUN,
        )
        return pd.read_csv(csv).set_index("method"), md

    return write_table


def test_median_quartiles_lpips_and_size_beside_the_thesis(written):
    table, md = written(thesis_mesh=True)
    ours = table.loc["256 wide"]
    assert ours[["frame_ms_q1", "frame_ms", "frame_ms_q3"]].tolist() == [20, 30, 40]
    assert ours["repeats"] == 5
    assert ours["lpips"] == pytest.approx(0.1)
    assert ours["lpips_low"] < ours["lpips"] < ours["lpips_high"]
    theirs = ours[["thesis_frame_ms", "thesis_lpips", "thesis_size_kib"]]
    assert theirs.tolist() == [29.1, 0.0379, 2175]
    assert ours["frame_ms_minus_thesis"] == pytest.approx(30 - 29.1)
    assert ours["size_kib_minus_thesis"] == 0
    assert cells_of(md, 0)["frame ms ↓"] == "30.0 [20.0, 40.0]"
    assert table["scene"].tolist() == ["dragon"] * 3 + ["fence"]


def test_baselines_have_what_applies_to_them(written):
    table, md = written(thesis_mesh=True)
    assert table.loc["Ray traced", ["lpips", "size_kib"]].isna().all()
    assert table.loc["512²", "size_kib"] == 1024
    assert table.loc["512²", "lpips"] == pytest.approx(0.3)
    assert cells_of(md, 1)["LPIPS ↓"] == ""


def test_of_another_mesh_the_thesis_says_sizes_alone(written):
    table, md = written(thesis_mesh=False)
    ours = table.loc["256 wide"]
    assert ours[["thesis_frame_ms", "thesis_lpips", "frame_ms_minus_thesis"]].isna().all()
    assert ours["thesis_size_kib"] == 2175
    assert (
        "*thesis* has sizes alone for dragon: it did not measure the mesh wyrm." in md.read_text()
    )

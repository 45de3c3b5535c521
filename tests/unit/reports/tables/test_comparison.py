import pytest
from report_samples import (
    cells_of,
    metrics_of,
    row,
    write_lpips,
    write_mesh,
    write_metrics,
    write_record,
    written_table,
)

from neural_shadows.reports.tables.comparison import write
from neural_shadows.reports.tables.quality import METRICS

ROWS = [
    row("dragon", "Thesis's network", published="network"),
    row("dragon_field", "Field", bias="held_out"),
    row("shadow_map_2048", "2048² shadow map"),
]
# lpips, psnr, ssim, flip, shadow_error, false_shadow, light_leak. FLIP orders unlike LPIPS.
MEANS = {
    "shadow_map_2048": (0.01, 38.0, 0.99, 0.05, 0.002, 0.001, 0.001),
    "dragon": (0.04, 27.0, 0.97, 0.03, 0.020, 0.012, 0.008),
    "dragon_field": (0.02, 35.0, 0.98, 0.04, 0.004, 0.002, 0.002),
}


@pytest.fixture
def written(tmp_path):
    def written(metrics=METRICS, published="4.3", **mesh):
        means = {
            method: {metric: mean for metric, mean in zip(METRICS, values) if metric in metrics}
            for method, values in MEANS.items()
        }
        bias_json = tmp_path / "depth_biases" / "dragon_field.json"
        return written_table(
            write,
            tmp_path,
            metrics=write_metrics(tmp_path, "dragon", metrics_of(means)),
            mesh_json=write_mesh(tmp_path, **mesh),
            depth_biases=[write_record(bias_json, {"depth_bias": 0.008})],
            lpips_json=write_lpips(tmp_path, "lpips" in metrics),
            title="Networks and maps",
            published=published,
            rows=ROWS,
        )

    return written


def test_rows_are_sorted_by_lpips_beside_the_thesis(written):
    table, md = written(thesis_mesh=True)
    assert table["method"].tolist() == ["2048² shadow map", "Field", "Thesis's network"]
    ours = table.iloc[2]
    theirs = ours[["thesis_lpips", "thesis_psnr", "thesis_ssim"]]
    assert theirs.tolist() == [0.0379, 27.39, 0.9772]
    assert ours["psnr_minus_thesis"] == pytest.approx(27 - 27.39)
    assert table.loc[1, ["thesis_lpips", "lpips_minus_thesis"]].isna().all()
    context = ours[["mesh", "scale", "width", "height", "lpips_net", "seed"]].tolist()
    assert context == ["wyrm", "test", 60, 40, "alex", 11]

    cells = cells_of(md, 2)
    assert cells["LPIPS ↓"] == f"0.0400 [{ours['lpips_low']:.4f}, {ours['lpips_high']:.4f}]"
    assert (cells["thesis LPIPS"], cells["thesis PSNR"]) == ("0.0379", "27.39")
    assert cells["shadow error % ↓"].startswith("2.00 [1.")
    text = md.read_text()
    assert text.startswith("# Networks and maps, mesh wyrm (table 4.3 of the thesis)\n")
    assert "Field: a depth bias of 0.008 sphere radii, the best on held-out views." in text
    assert "Network dragon: 100 parameters, 10 steps of 64 samples" in text


def test_the_thesis_says_nothing_of_another_mesh(written):
    table, md = written()
    assert table[["thesis_lpips", "thesis_psnr", "psnr_minus_thesis"]].isna().all(axis=None)
    assert cells_of(md, 0)["thesis PSNR"] == ""
    text = md.read_text()
    assert text.startswith("# Networks and maps, mesh wyrm (after table 4.3 of the thesis)\n")
    assert "*thesis*: empty, since it did not measure the mesh wyrm." in text
    # A table of one's own does not mention the thesis.
    _, md = written(published=None)
    assert not any(heading.startswith("thesis") for heading in cells_of(md, 0))
    assert "*thesis*" not in md.read_text()


def test_without_lpips_flip_sorts(written):
    table, md = written(metrics=METRICS[1:], thesis_mesh=True)
    assert table["method"].tolist() == ["Thesis's network", "Field", "2048² shadow map"]
    assert table["lpips"].isna().all() and table["thesis_lpips"].notna().any()
    assert list(cells_of(md, 0))[:2] == ["method", "PSNR ↑"]
    (note,) = (line for line in md.read_text().splitlines() if "LPIPS is missing" in line)
    assert len(note) <= 150

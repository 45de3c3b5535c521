import pytest
import report_samples as samples

from neural_shadows.reports.tables.comparison import write
from neural_shadows.reports.tables.quality import METRICS

ROWS = [
    samples.row("dragon", "Thesis's network", published="network"),
    samples.row("dragon_field", "Field", bias="held_out"),
    samples.row("shadow_map_2048", "2048² shadow map"),
]
# By metric of METRICS. FLIP orders unlike LPIPS.
MEANS = {
    "shadow_map_2048": (0.01, 38.0, 0.99, 0.05, 0.002, 0.001, 0.001),
    "dragon": (0.04, 27.0, 0.97, 0.03, 0.020, 0.012, 0.008),
    "dragon_field": (0.02, 35.0, 0.98, 0.04, 0.004, 0.002, 0.002),
}


@pytest.fixture
def written(tmp_path):
    def written(first=0, **mesh):
        means = {key: dict(list(zip(METRICS, values))[first:]) for key, values in MEANS.items()}
        lpips = samples.LPIPS | {"available": not first}
        bias_json = tmp_path / "depth_biases" / "dragon_field.json"
        return samples.written_table(
            write,
            tmp_path,
            metrics=[samples.write_metrics(tmp_path, means)],
            mesh_json=samples.write_mesh(tmp_path, **mesh),
            depth_biases=[samples.write_record(bias_json, {"depth_bias": 0.008})],
            lpips_json=samples.write_record(tmp_path / "found.json", lpips),
            published="4.3",
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
    cells = samples.cells_of(md, 2)
    assert cells["LPIPS ↓"] == f"0.0400 [{ours['lpips_low']:.4f}, {ours['lpips_high']:.4f}]"
    assert (cells["thesis LPIPS"], cells["thesis PSNR"]) == ("0.0379", "27.39")
    assert "Field: a depth bias of 0.008 sphere radii, the best on held" in md.read_text()


def test_the_thesis_says_nothing_of_another_mesh(written):
    table, md = written(thesis_mesh=False)
    assert table[["thesis_lpips", "thesis_psnr", "psnr_minus_thesis"]].isna().all(axis=None)
    assert samples.cells_of(md, 0)["thesis PSNR"] == ""
    assert "Title, mesh wyrm (after table 4.3 of the thesis)\n" in md.read_text()


def test_without_lpips_flip_sorts(written):
    table, md = written(first=1)
    assert table["method"].tolist() == ["Thesis's network", "Field", "2048² shadow map"]
    assert table["lpips"].isna().all()
    assert list(samples.cells_of(md, 0))[:2] == ["method", "PSNR ↑"]
    assert "LPIPS is missing" in md.read_text()

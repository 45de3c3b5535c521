import pytest
import report_samples as samples

from neural_shadows.reports.data.quality import METRICS
from neural_shadows.reports.tables.comparison import table as make_table

FIELD = samples.TRAINING | {"name": "dragon_field"}
ROWS = [
    samples.row("no_shadow", "No shadow"),
    samples.row("dragon", "Thesis's network", published="network"),
    samples.row("dragon_field", "Field", bias="held_out"),
    samples.row("shadow_map_128_biased", "128² shadow map, with bias", bias="held_out"),
    samples.row("shadow_map_512", "512² shadow map"),
    samples.row("shadow_map_2048", "2048² shadow map"),
]
# By metric of METRICS. FLIP orders unlike LPIPS.
MEANS = {
    "no_shadow": (0.03, 27.0, 0.95, 0.07, 0.100, 0.000, 0.100),
    "shadow_map_2048": (0.01, 38.0, 0.99, 0.05, 0.002, 0.001, 0.001),
    "shadow_map_512": (0.02, 32.0, 0.985, 0.06, 0.008, 0.004, 0.004),
    "shadow_map_128_biased": (0.05, 26.0, 0.96, 0.08, 0.030, 0.020, 0.010),
    "dragon": (0.04, 27.0, 0.97, 0.03, 0.020, 0.012, 0.008),
    "dragon_field": (0.015, 35.0, 0.98, 0.04, 0.004, 0.002, 0.002),
}
ORDER = ["2048² shadow map", "Field", "512² shadow map", "Thesis's network"]
ORDER += ["128² shadow map, with bias", "No shadow"]


@pytest.fixture
def written(tmp_path):
    def written(
        first=0,
        against=None,
        records=(samples.TRAINING, FIELD),
        rows=ROWS,
        views=12,
        more_metrics=(),
        **mesh,
    ):
        means = {key: dict(list(zip(METRICS, values))[first:]) for key, values in MEANS.items()}
        lpips = samples.LPIPS | {"available": not first}
        biases = {"dragon_field": (0.008, True), "shadow_map_128": (-0.002, False)}
        trainings = tmp_path / "trainings"
        return samples.written_table(
            make_table,
            tmp_path,
            metrics=[samples.write_metrics(tmp_path, means, views=views)],
            mesh_json=samples.write_mesh(tmp_path, **mesh),
            trainings=[samples.write_record(trainings / one["name"], one) for one in records],
            depth_biases=[
                samples.write_record(
                    tmp_path / f"constants/dragon/{name}.json",
                    samples.constants_of(bias, 0.0, at_end),
                )
                for name, (bias, at_end) in biases.items()
            ],
            lpips_json=samples.write_record(tmp_path / "found.json", lpips),
            published="4.3",
            against=against,
            more_metrics=more_metrics,
            rows=rows,
        )

    return written


def test_rows_are_sorted_by_lpips_beside_the_thesis_and_no_shadow_is_last(written):
    table, md = written(thesis_mesh=True)
    assert table["method"].tolist() == ORDER
    ours = table.iloc[3]
    theirs = ours[["thesis_lpips", "thesis_psnr", "thesis_ssim"]]
    assert theirs.tolist() == [0.0379, 27.39, 0.9772]
    assert ours["psnr_minus_thesis"] == pytest.approx(27 - 27.39)
    assert table.loc[1, ["thesis_lpips", "lpips_minus_thesis"]].isna().all()
    context = ours[["mesh", "scale", "width", "height", "lpips_net", "seed"]].tolist()
    assert context == ["wyrm", "test", 60, 40, "alex", 11]
    cells = samples.cells_of(md, 3)
    assert cells["LPIPS ↓"] == f"0.0400 [{ours['lpips_low']:.4f}, {ours['lpips_high']:.4f}]"
    assert (cells["thesis LPIPS"], cells["thesis PSNR"]) == ("0.0379", "27.39")
    text = md.read_text()
    assert "Field: a depth bias of 0.008 sphere radii, the best on held-out views (at" in text
    assert (
        "Cast shadow on dragon, of visible points: 9.9 % in shadow views, 10 % in surface" in text
    )


def test_a_network_like_no_shadow_has_not_learned(written):
    table, md = written()
    assert table["learned"].tolist()[1] and not table["learned"][3]
    # A map has learned nothing either way, nor has what is built without a training.
    assert table["learned"].isna().tolist() == [True, False, True, False, True, True]
    assert samples.cells_of(md, 3)["method"] == "Thesis's network (**not learned**)"
    assert samples.cells_of(md, 1)["method"] == "Field"
    built = [row | {"trained": row["method"] == "dragon"} for row in ROWS]
    untrained = FIELD | {"training": None, "samples": 0}
    table, md = written(records=(samples.TRAINING, untrained), rows=built)
    assert table["learned"].isna()[1] and not table["learned"][3]
    assert "Network dragon_field: 100 parameters, built without training in 2 s" in md.read_text()


def test_maps_that_would_be_as_good(written):
    table, md = written(thesis_mesh=True)
    # Between 512² (0.02) and 2048² (0.01) linear in the logarithms.
    assert table["map_lpips"].fillna("").tolist() == ["", "910", "", "< 512", "< 512", "< 512"]
    assert samples.cells_of(md, 1)["equal map"].startswith("910² / 10")
    # The thesis's own, by its own maps; it prints no field.
    assert samples.cells_of(md, 3)["thesis equal map"] == "386² / 191²"
    assert samples.cells_of(md, 1)["thesis equal map"] == ""


def test_differences_are_of_the_same_views(written):
    table, md = written(against="shadow_map_512")
    found = table.set_index("method")
    assert found["lpips_difference"]["Field"] == pytest.approx(-0.005)
    assert found["lpips_difference_high"]["Field"] < 0
    pooled = found["psnr_pooled"]
    expected = pooled["Field"] - pooled["512² shadow map"]
    assert found["psnr_difference"]["Field"] == pytest.approx(expected, abs=1e-3)
    assert found.loc["512² shadow map", ["lpips_difference", "psnr_difference"]].isna().all()
    assert samples.cells_of(md, 1)["difference, dB"].startswith(f"+{expected:.2f} [")


def test_the_thesis_says_nothing_of_another_mesh(written):
    table, md = written(thesis_mesh=False)
    theirs = ["thesis_lpips", "thesis_psnr", "psnr_minus_thesis", "thesis_map_lpips"]
    assert table[theirs].isna().all(axis=None)
    assert "wyrm (generated, not the thesis's mesh)" in md.read_text()
    # What is made to its description stands beside its numbers, and is said to be made so.
    same = written(thesis_mesh=True)[1].read_text()
    assert "wyrm (generated, not the thesis's mesh)" in same
    _, md = written(thesis_mesh=False)
    assert "thesis PSNR" not in samples.cells_of(md, 0)
    assert "Title, mesh wyrm (after table 4.3 of the thesis)\n" in md.read_text()


def test_without_lpips_flip_sorts(written):
    table, md = written(first=1)
    assert table["method"].tolist()[:2] == ["Thesis's network", "Field"]
    assert table[["lpips", "map_lpips"]].isna().all(axis=None)
    assert samples.cells_of(md, 1)["equal map"].startswith("– / 10")
    assert list(samples.cells_of(md, 0))[:3] == ["method", "FLIP ↓", "PSNR ↑"]


def test_further_metrics_are_columns(written):
    _, md = written(more_metrics=["flip", "false_shadow"])
    cells = samples.cells_of(md, 0)
    assert cells["FLIP ↓"].startswith("0.0500 [") and cells["false shadow % ↓"].startswith("0.10 [")

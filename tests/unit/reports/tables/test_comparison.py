from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from neural_shadows.errors import InputError
from neural_shadows.evaluation.per_view_metrics import read_metrics
from neural_shadows.reports.published import read_published
from neural_shadows.reports.tables.comparison import METRICS, comparison_table, write_table

ROOT = Path(__file__).parents[4]
CONTEXT = {
    "mesh": "wyrm",
    "scale": "desk",
    "width": 240,
    "height": 160,
    "lpips_net": "alex",
    "seed": 11,
}
ROWS = [
    {"method": "network", "label": "Our method", "published": None},
    {"method": "shadow_map_128", "label": "128² shadow map", "published": None},
    {"method": "shadow_map_2048", "label": "2048² shadow map", "published": None},
]
# lpips, psnr, ssim, flip, shadow_error, false_shadow, light_leak. FLIP orders unlike LPIPS.
MEANS = {
    "shadow_map_2048": (0.01, 38.0, 0.99, 0.05, 0.002, 0.001, 0.001),
    "network": (0.04, 27.0, 0.97, 0.03, 0.020, 0.012, 0.008),
    "shadow_map_128": (0.15, 24.0, 0.93, 0.09, 0.060, 0.030, 0.030),
}


@pytest.fixture(scope="module")
def published():
    return read_published(ROOT / "config" / "published.csv")


@pytest.fixture
def metrics():
    """Eight views whose values lie evenly about MEANS, so the means are known."""
    spread = np.linspace(-0.1, 0.1, 8)
    return pd.DataFrame(
        [
            (i % 4, "shadow" if i < 4 else "surface", method, metric, mean * (1 + spread[i]))
            for i in range(8)
            for method, means in MEANS.items()
            for metric, mean in zip(METRICS, means, strict=True)
        ],
        columns=["view", "view_set", "method", "metric", "value"],
    )


def table_of(metrics, published, rows=ROWS):
    return comparison_table(metrics, rows, "4.3", published, CONTEXT, seed=1)


def test_means_order_and_columns(metrics, published):
    table = table_of(metrics, published)
    assert list(table.columns[:8]) == [
        "method",
        "lpips",
        "psnr",
        "ssim",
        "flip",
        "shadow_error",
        "false_shadow",
        "light_leak",
    ]
    assert list(table.columns[8:22]) == [f"{m}_{end}" for m in METRICS for end in ("low", "high")]
    assert list(table.columns[22:]) == [
        "views",
        "thesis_lpips",
        "thesis_psnr",
        "thesis_ssim",
        "lpips_minus_thesis",
        "psnr_minus_thesis",
        "ssim_minus_thesis",
        "mesh",
        "scale",
        "width",
        "height",
        "lpips_net",
        "seed",
    ]
    assert list(table["method"]) == ["2048² shadow map", "Our method", "128² shadow map"]
    np.testing.assert_allclose(table[list(METRICS)], list(MEANS.values()), rtol=1e-12)
    for metric in METRICS:
        assert (table[f"{metric}_low"] < table[metric]).all()
        assert (table[f"{metric}_high"] > table[metric]).all()
    assert (table["views"] == 8).all()
    assert table.loc[0, list(CONTEXT)].to_dict() == CONTEXT


def test_interval_width_is_that_of_normal_theory(metrics, published):
    ours = table_of(metrics, published).iloc[1]
    values = metrics.query("method == 'network' and metric == 'psnr'")["value"]
    half = 1.96 * values.std(ddof=0) / np.sqrt(len(values))
    assert ours["psnr_high"] - ours["psnr_low"] == pytest.approx(2 * half, rel=0.1)


def test_thesis_values_and_differences(metrics, published):
    ours = table_of(metrics, published).iloc[1]
    assert ours["thesis_lpips"] == 0.0379
    assert ours["lpips_minus_thesis"] == pytest.approx(0.04 - 0.0379)
    assert ours["psnr_minus_thesis"] == pytest.approx(27.0 - 27.39)
    assert ours["ssim_minus_thesis"] == pytest.approx(0.97 - 0.9772)


def test_without_lpips_the_columns_are_empty_and_flip_sorts(metrics, published):
    table = table_of(metrics[metrics["metric"] != "lpips"], published)
    assert list(table["method"]) == ["Our method", "2048² shadow map", "128² shadow map"]
    for column in ("lpips", "lpips_low", "lpips_high", "lpips_minus_thesis"):
        assert table[column].isna().all()
    assert table["thesis_lpips"].notna().all()


def test_one_view_has_no_width(metrics, published):
    table = table_of(metrics.query("view_set == 'shadow' and view == 2"), published)
    assert (table["psnr_low"] == table["psnr"]).all()
    assert (table["views"] == 1).all()


def test_a_method_without_metrics_is_named(metrics, published):
    rows = [*ROWS, {"method": "shadow_map_64", "label": "64² shadow map", "published": None}]
    with pytest.raises(InputError, match="shadow_map_64 has no values of lpips: delete a.csv and"):
        table_of(metrics.assign(file="a.csv"), published, rows)


def test_lpips_of_some_methods_only_is_refused(metrics, published):
    some = metrics[(metrics["metric"] != "lpips") | (metrics["method"] != "network")]
    with pytest.raises(InputError, match="network has no values of lpips"):
        table_of(some, published)


def test_fewer_views_are_refused_and_the_file_is_named(metrics, published):
    metrics = metrics.assign(file=np.where(metrics["view_set"] == "shadow", "a.csv", "b.csv"))
    gone = metrics.eval("method == 'network' and metric == 'flip' and view == 3")
    gone &= metrics["view_set"] == "surface"
    with pytest.raises(InputError, match=r"network has flip of 7 views, others have 8 .*b\.csv"):
        table_of(metrics[~gone], published)


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_values_that_are_not_finite_are_refused(metrics, published, value):
    metrics.loc[metrics.eval("method == 'network' and metric == 'ssim' and view == 2"), "value"] = (
        value
    )
    with pytest.raises(InputError, match="ssim of method network in shadow view 2 is"):
        table_of(metrics, published)


def test_other_methods_and_metrics_are_left_out(metrics, published):
    other = pd.DataFrame(
        {"view": [0], "view_set": "shadow", "method": "network", "metric": "frame_ms", "value": 9.0}
    )
    table = table_of(pd.concat([metrics, other]), published, ROWS[:1])
    assert len(table) == 1
    assert "frame_ms" not in table


def test_written_table(metrics, published, tmp_path):
    table = table_of(metrics, published)
    csv_path, md_path = tmp_path / "table_4_3.csv", tmp_path / "table_4_3.md"
    write_table(table, csv_path, md_path, title="Table 4.3", notes=["Scale: desk", "Mesh: wyrm"])
    assert csv_path.read_text().startswith("method,lpips,psnr,ssim,flip,")
    back = pd.read_csv(csv_path)
    pd.testing.assert_frame_equal(back, table, rtol=1e-5, check_dtype=False)

    lines = md_path.read_text().splitlines()
    assert lines[0] == "# Table 4.3"
    heads, ours = ([cell.strip() for cell in lines[i].split("|")[1:-1]] for i in (2, 5))
    cells = dict(zip(heads, ours, strict=True))
    row = table.iloc[1]
    assert cells["method"] == "Our method"
    assert cells["LPIPS ↓"] == f"0.0400 [{row['lpips_low']:.4f}, {row['lpips_high']:.4f}]"
    assert cells["PSNR ↑"].startswith("27.00 [")
    assert cells["shadow error % ↓"].startswith("2.00 [1.")
    assert (cells["thesis LPIPS"], cells["thesis PSNR"]) == ("0.0379", "27.39")
    assert lines[-2:] == ["- Scale: desk", "- Mesh: wyrm"]


def test_written_table_without_lpips_says_so(metrics, published, tmp_path):
    table = table_of(metrics[metrics["metric"] != "lpips"], published)
    write_table(table, tmp_path / "t.csv", tmp_path / "t.md", title="T", notes=[])
    assert (tmp_path / "t.csv").read_text().splitlines()[1].startswith("Our method,,27,0.97,0.03,")
    assert (tmp_path / "t.md").read_text().count("not available") == 3


def test_batches_are_joined(metrics, tmp_path):
    paths = [tmp_path / "batch_0.csv", tmp_path / "batch_1.csv"]
    for path, view_set in zip(paths, ("shadow", "surface"), strict=True):
        metrics[metrics["view_set"] == view_set].to_csv(path, index=False)
    joined = read_metrics(paths)
    pd.testing.assert_frame_equal(joined.drop(columns="file"), metrics)
    assert set(joined["file"]) == {str(path) for path in paths}
    assert joined["view"].dtype == np.int64


HEAD = "view,view_set,method,metric,value\n"


@pytest.mark.parametrize(
    "text",
    [
        "",
        HEAD,
        HEAD + "0,shadow,network,psnr,27.3",  # perhaps cut within the number
        HEAD + "0,shadow,network,psnr,27.3\n1,shadow,net",
        HEAD + "0,shadow,network,psnr,27.3\n1,shadow,network\n",
        HEAD + "0,shadow,network,psnr,inf\n",
        HEAD + "0,shadow,network,psnr,nan\n",
        HEAD + "zero,shadow,network,psnr,27.3\n",
        HEAD + "0,shadow,network,psnr,27.3,7,8\n0,shadow,network,ssim,0.9\n",
        "method,lpips,psnr\nnetwork,0.1,27.3\n",
        "\x89PNG\r\n\x1a\n\x00\x00",
    ],
)
def test_a_broken_file_is_named(tmp_path, text):
    path = tmp_path / "batch_7.csv"
    path.write_text(text, encoding="latin-1")
    with pytest.raises(InputError, match="moved to batch_7.csv.broken, run again") as caught:
        read_metrics([path])
    assert str(path) in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(InputError, match=r"batch_9\.csv: no such file"):
        read_metrics([tmp_path / "batch_9.csv"])


def test_a_view_given_twice_is_refused(metrics, tmp_path):
    paths = [tmp_path / "batch_0.csv", tmp_path / "batch_1.csv"]
    for path in paths:
        metrics.to_csv(path, index=False)
    with pytest.raises(InputError, match=r"batch_1\.csv: lpips of shadow_map_2048 in shadow view"):
        read_metrics(paths)

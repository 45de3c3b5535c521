import numpy as np
import pytest
from report_samples import all_metrics, metrics_of, row

from neural_shadows.errors import InputError
from neural_shadows.reports.tables.quality import METRICS, quality_table

ROWS = [row("network", "Network"), row("shadow_map_128", "128²")]


@pytest.fixture
def metrics():
    return metrics_of({"network": all_metrics(0.2), "shadow_map_128": all_metrics(0.4)})


def test_means_and_intervals_in_the_order_of_the_rows(metrics):
    table = quality_table(metrics, ROWS[::-1], seed=1)
    ends = [f"{metric}_{end}" for metric in METRICS for end in ("low", "high")]
    assert list(table) == ["method", *METRICS, *ends, "views"]
    assert table["method"].tolist() == ["128²", "Network"]
    assert (table["views"] == 8).all()
    values = metrics.query("method == 'network' and metric == 'psnr'")["value"]
    half = 1.96 * values.std(ddof=0) / np.sqrt(len(values))  # of normal theory
    for metric in METRICS:
        assert table[metric].tolist() == pytest.approx([0.4, 0.2])
        assert (table[f"{metric}_low"] < table[metric]).all()
        assert table[f"{metric}_high"][1] - table[f"{metric}_low"][1] == pytest.approx(
            2 * half, rel=0.1
        )
    # The order of files changes nothing.
    shuffled = metrics.sample(frac=1, random_state=1)
    assert quality_table(shuffled, ROWS[::-1], seed=1).equals(table)


def test_one_view_has_no_width(metrics):
    table = quality_table(metrics.query("view_set == 'shadow' and view == 2"), ROWS, seed=1)
    assert (table["psnr_low"] == table["psnr"]).all()


def test_without_lpips_its_columns_are_empty(metrics):
    table = quality_table(metrics.query("metric != 'lpips'"), ROWS, seed=1)
    assert table[["lpips", "lpips_low", "lpips_high"]].isna().all(axis=None)


@pytest.mark.parametrize("gone", ["lpips", "flip"])
def test_a_value_that_others_have_is_missed(metrics, gone):
    missing = metrics.eval("method == 'network' and metric == @gone and view == 3")
    with pytest.raises(InputError, match=f"network has no finite {gone} of shadow view 3"):
        quality_table(metrics[~missing], ROWS, seed=1)

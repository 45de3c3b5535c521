import numpy as np
import pytest
from report_samples import metrics_of, row
from scipy import stats

from neural_shadows.errors import InputError
from neural_shadows.reports.data.quality import METRICS, quality_table, values_by_view

ROWS = [row("shadow_map_128", "128²"), row("network", "Network")]
METHODS = [row["method"] for row in ROWS]
MEANS = {"network": dict.fromkeys(METRICS, 0.2), "shadow_map_128": dict.fromkeys(METRICS, 0.4)}


def test_means_and_intervals_in_the_order_of_the_rows():
    metrics = metrics_of(MEANS)
    table = quality_table(values_by_view(metrics, METHODS), ROWS, seed=1)
    assert table["method"].tolist() == ["128²", "Network"]
    assert (table["views"] == 8).all()
    values = metrics.query("method == 'network' and metric == 'psnr'")["value"]
    # Of Student's t; of so few views the farthest of 2,000 means are a little nearer.
    half = stats.t.ppf(0.975, 7) * values.std(ddof=1) / np.sqrt(len(values))
    for metric in METRICS:
        assert table[metric].tolist() == pytest.approx([0.4, 0.2])
        low, high = table[f"{metric}_low"][1], table[f"{metric}_high"][1]
        assert low < 0.2 < high and high - low == pytest.approx(2 * half, rel=0.1)
    # The order of files changes nothing.
    shuffled = values_by_view(metrics.sample(frac=1, random_state=1), METHODS)
    assert quality_table(shuffled, ROWS, seed=1).equals(table)


def test_identical_frames_do_not_drive_the_pooled_psnr():
    metrics = metrics_of(MEANS)
    # Errors of 1e-2 in six views of eight; two views equal the reference.
    chosen = metrics.eval("method == 'network' and metric == 'psnr'")
    metrics.loc[chosen, "value"] = [20.0] * 6 + [100.0] * 2
    found = quality_table(values_by_view(metrics, METHODS), ROWS, seed=1).iloc[1]
    assert (found["psnr"], found["psnr_median"], found["identical"]) == (40, 20, 2)
    assert found["psnr_pooled"] == pytest.approx(20 - 10 * np.log10(0.75))
    # No draw of views has an error above 1e-2.
    assert 20 <= found["psnr_pooled_low"] < found["psnr_pooled"] < found["psnr_pooled_high"] < 30


@pytest.mark.parametrize("gone", ["lpips", "flip"])
def test_a_value_that_others_have_is_missed(gone):
    metrics = metrics_of(MEANS)
    missing = metrics.eval("method == 'network' and metric == @gone and view == 3")
    with pytest.raises(InputError, match=f"network has no finite {gone} of shadow view 3"):
        values_by_view(metrics[~missing], METHODS)

import numpy as np
import pandas as pd
import pytest
from report_samples import PUBLISHED, row

from neural_shadows.reports.data.learned import has_learned, learned, learned_methods, margins
from neural_shadows.reports.data.published import read_published

METRICS = ("lpips", "psnr", "ssim")


def views(lpips, psnr, ssim, spread=0.0, count=12):
    """Metrics of views about these means, `spread` of the mean either way."""
    factor = 1 + spread * np.linspace(-1, 1, count)
    means = zip(METRICS, (lpips, psnr, ssim))
    return pd.DataFrame({name: mean * factor for name, mean in means})


def test_margins_are_the_difference_of_the_thesis_from_itself():
    found = margins(read_published(PUBLISHED))
    assert found == pytest.approx({"lpips": 0.0013, "psnr": 0.18, "ssim": 0.0003})


def test_advantage_beyond_the_margin_is_of_pairs_and_of_pooled_psnr():
    # The views differ far more among themselves than the two methods do.
    null = views(0.2, 20, 0.9, spread=0.3)
    network = null - [0.01, 0, 0] + [0, 3, 0.02]
    found = learned(network, null, METRICS, {"psnr": 0.5}, seed=1)
    # A factor of all errors is a difference of pooled PSNR, whatever the views.
    assert found["psnr"] == pytest.approx((2.5, 2.5, 2.5))
    assert found["lpips"] == pytest.approx((0.01, 0.01, 0.01))
    assert found["ssim"] == pytest.approx((0.02, 0.02, 0.02))
    assert has_learned(found)
    assert not has_learned(learned(network, null, METRICS, {"psnr": 3.0}, seed=1))


@pytest.mark.parametrize("metric", METRICS)
def test_one_metric_no_better_than_no_shadow_is_enough(metric):
    null = views(0.2, 20, 0.9)
    network = views(0.1, 30, 0.95)
    network[metric] = null[metric]
    assert not has_learned(learned(network, null, METRICS, {}, seed=1))


def test_only_what_is_trained_has_learned_or_not_and_few_views_say_nothing():
    null, network = views(0.2, 20, 0.9), views(0.1, 30, 0.95)
    wide = pd.concat({"no_shadow": null, "net": network, "built": null, "bad": null}, axis=1)
    rows = [row("net"), row("bad"), row("built", trained=False), row("no_shadow")]
    assert learned_methods(wide, rows, {}, seed=1) == {"net": True, "bad": False}
    assert learned_methods(wide[:9], rows, {}, seed=1) == {}

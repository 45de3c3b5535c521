import numpy as np
import pytest
from scipy import stats

from neural_shadows.metrics.intervals import (
    difference_interval,
    mean_interval,
    median_ratio_interval,
)


def test_a_share_gives_the_binomial_percentiles():
    # The resampled mean of k ones among n is exactly Binomial(n, k/n)/n. So few are skew:
    # percentiles 0 and 5 of 40 about a mean of 2, where other bootstraps give -1 and 4.
    mean, low, high = mean_interval(np.repeat([1.0, 0.0], [2, 38]), seed=3, resamples=20_000)
    exact = stats.binom(40, 2 / 40)
    assert mean == 2 / 40
    assert low == pytest.approx(exact.ppf(0.025) / 40, abs=1e-12)
    assert high == pytest.approx(exact.ppf(0.975) / 40, abs=1e-12)


def test_difference_has_the_width_of_both_samples():
    rng = np.random.default_rng(6)
    a, b = rng.normal(3.0, 2.0, 1500), rng.normal(1.0, 1.0, 500)
    difference, low, high = difference_interval(a, b, seed=2, resamples=8000)
    half = stats.norm.ppf(0.975) * np.sqrt(a.var() / a.size + b.var() / b.size)
    assert difference == pytest.approx(a.mean() - b.mean())
    assert low == pytest.approx(difference - half, abs=0.06 * half)
    assert high == pytest.approx(difference + half, abs=0.06 * half)


def test_ratio_of_medians():
    # What a round has in common cancels: a is 1.5 b in each, so in each resampling too.
    b = np.random.default_rng(7).lognormal(0.0, 1.0, 15)
    assert median_ratio_interval(1.5 * b, b, seed=1) == pytest.approx((1.5, 1.5, 1.5))
    # With b fixed at 1 the ratio is a's median, whose 95 % order-statistic interval of 101
    # values is from the 41st to the 61st (binomial: 50.5 +- 1.96 * 5.02).
    a = np.sort(np.random.default_rng(8).uniform(1.0, 2.0, 101))
    ratio, low, high = median_ratio_interval(a, np.ones(101), seed=3, resamples=8000)
    assert ratio == np.median(a)
    assert a[38] <= low <= a[42] and a[58] <= high <= a[62]

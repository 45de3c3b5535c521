import numpy as np
import pytest
from scipy import stats

from neural_shadows.metrics.intervals import (
    mean_interval,
    paired_difference,
    t_interval,
    two_way_interval,
)


def test_a_share_gives_the_binomial_percentiles():
    # The resampled mean of k ones among n is exactly Binomial(n, k/n)/n. So few are skew:
    # percentiles 0 and 5 of 40 about a mean of 2, where other bootstraps give -1 and 4.
    mean, low, high = mean_interval(np.repeat([1.0, 0.0], [2, 38]), seed=3, resamples=20_000)
    exact = stats.binom(40, 2 / 40)
    assert mean == 2 / 40
    assert low == pytest.approx(exact.ppf(0.025) / 40, abs=1e-12)
    assert high == pytest.approx(exact.ppf(0.975) / 40, abs=1e-12)


def test_differences_of_the_same_views_are_paired():
    rng = np.random.default_rng(9)
    views = rng.normal(0, 5, 200)
    a, b = views + 1 + rng.normal(0, 0.1, 200), views + rng.normal(0, 0.1, 200)
    difference, low, high = paired_difference(a, b, seed=1)
    half = 1.96 * (a - b).std() / np.sqrt(200)
    assert (difference, high - low) == pytest.approx(((a - b).mean(), 2 * half), rel=0.1)


def test_one_value_a_training_is_students():
    values = [2.0, 4.0, 6.0]
    mean, low, high, p = t_interval(values)
    exact = stats.ttest_1samp(values, 0)
    assert (mean, p) == pytest.approx((4.0, exact.pvalue))
    assert (low, high) == pytest.approx(tuple(exact.confidence_interval(0.95)))
    assert t_interval([3.0]) == (3.0, -np.inf, np.inf, 1.0)
    assert t_interval([0.0, 0.0])[3] == 1.0  # methods that are alike differ in nothing


def test_three_trainings_and_few_views_are_covered():
    # Means of trainings differ more than means of views. Drawing the three trainings with
    # replacement would cover 86 % of the true means (here 97), views alone 70 %.
    rng, hits, rejected, views_alone = np.random.default_rng(1), 0, 0, 0
    groups = np.arange(16) % 2
    for i in range(150):
        effects = rng.normal(0, 0.6, (3, 1)), rng.normal(0, 1, 16), rng.normal(0, 0.5, (3, 16))
        values = sum(effects) + 10 * groups - 5
        _, low, high, p = two_way_interval(values, i, groups=groups, resamples=200)
        hits += low <= 0 <= high
        rejected += p < 0.05
        _, low, high, _ = two_way_interval(values.mean(0)[None], i, groups=groups, resamples=200)
        views_alone += low <= 0 <= high
    assert hits >= 138 and rejected <= 12
    assert views_alone < 125


def test_places_of_groups_are_kept_so_that_two_scenes_can_be_compared():
    # Of the first scene 4 views about 10, of the second 6 about 3; no spread within.
    values = np.tile(np.repeat([10.0, 3.0], [4, 6]), (3, 1))
    groups = np.repeat(["a", "b"], [4, 6])

    def difference(some):
        return some[:, :4].mean() - some[:, 4:].mean()

    found = two_way_interval(values, 1, difference, groups, resamples=100)
    assert found == pytest.approx((7, 7, 7, 2 / 101))
    # A method against itself is never said to differ.
    assert two_way_interval(0 * values, 1, difference, groups, resamples=100)[3] == 1.0
    # One training: the interval of its views alone.
    row = np.random.default_rng(4).normal(0, 1, 300)
    _, low, high, _ = two_way_interval(row[None], seed=5)
    assert (low, high) == pytest.approx(mean_interval(row, seed=5)[1:], abs=0.02)

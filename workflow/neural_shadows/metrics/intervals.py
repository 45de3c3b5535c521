"""Means over views and how sure they are."""

import numpy as np
from scipy.stats import bootstrap


def mean_interval(
    values: np.ndarray, seed: int, resamples: int = 2000, level: float = 0.95
) -> tuple[float, float, float]:
    """Mean of `values`, shape (n,), and its percentile bootstrap interval: (mean, low, high).

    Views are drawn with replacement. The same seed draws the same views for every series of
    the same length, so intervals of methods seen from the same views can be compared. A single
    value says nothing about its spread: low = high = mean.
    """
    values = np.asarray(values, dtype=np.float64)
    mean = float(values.mean())
    if values.size == 1:
        return mean, mean, mean
    interval = bootstrap(
        (values,),
        np.mean,
        n_resamples=resamples,
        confidence_level=level,
        method="percentile",
        rng=np.random.default_rng(seed),
    ).confidence_interval
    return mean, float(interval.low), float(interval.high)


def difference_interval(
    a: np.ndarray, b: np.ndarray, seed: int, resamples: int = 2000, level: float = 0.95
) -> tuple[float, float, float]:
    """Difference of the means of two independent samples, (n,) and (m,): (a − b, low, high).

    For values of the same views take `mean_interval` of their differences instead: what
    the views have in common then cancels.
    """
    return _two_samples(a, b, _mean_difference, False, seed, resamples, level)


def median_ratio_interval(
    a: np.ndarray, b: np.ndarray, seed: int, resamples: int = 2000, level: float = 0.95
) -> tuple[float, float, float]:
    """Ratio of the medians of two series (n,) taken in the same rounds: (a / b, low, high)."""
    return _two_samples(a, b, _median_ratio, True, seed, resamples, level)


def _mean_difference(a: np.ndarray, b: np.ndarray, axis: int = -1) -> np.ndarray:
    return a.mean(axis) - b.mean(axis)


def _median_ratio(a: np.ndarray, b: np.ndarray, axis: int = -1) -> np.ndarray:
    return np.median(a, axis) / np.median(b, axis)


def _two_samples(a, b, statistic, paired, seed, resamples, level):
    interval = bootstrap(
        (a, b),
        statistic,
        n_resamples=resamples,
        confidence_level=level,
        method="percentile",
        paired=paired,
        vectorized=True,
        rng=np.random.default_rng(seed),
    ).confidence_interval
    return float(statistic(a, b)), float(interval.low), float(interval.high)

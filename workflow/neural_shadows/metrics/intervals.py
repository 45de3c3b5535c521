"""Means over views and how sure they are: 95 % percentile bootstrap intervals."""

from collections.abc import Callable

import numpy as np
from scipy.stats import bootstrap


def mean_interval(
    values: np.ndarray, seed: int, resamples: int = 2000
) -> tuple[float, float, float]:
    """Mean of `values`, shape (n,), and its interval: (mean, low, high).

    Views are drawn with replacement. The same seed draws the same views for every series of
    the same length, so intervals of methods seen from the same views can be compared. A single
    value says nothing about its spread: low = high = mean.
    """
    values = np.asarray(values, dtype=np.float64)
    if values.size == 1:
        return (float(values[0]),) * 3
    return _interval((values,), np.mean, seed, resamples)


def difference_interval(
    a: np.ndarray, b: np.ndarray, seed: int, resamples: int = 2000
) -> tuple[float, float, float]:
    """Difference of the means of two independent samples, (n,) and (m,): (a − b, low, high).

    For values of the same views take `mean_interval` of their differences instead: what
    the views have in common then cancels.
    """
    return _interval((a, b), _mean_difference, seed, resamples)


def median_ratio_interval(
    a: np.ndarray, b: np.ndarray, seed: int, resamples: int = 2000
) -> tuple[float, float, float]:
    """Ratio of the medians of two series (n,) taken in the same rounds: (a / b, low, high)."""
    return _interval((a, b), _median_ratio, seed, resamples, paired=True)


def _mean_difference(a: np.ndarray, b: np.ndarray, axis: int = -1) -> np.ndarray:
    return a.mean(axis) - b.mean(axis)


def _median_ratio(a: np.ndarray, b: np.ndarray, axis: int = -1) -> np.ndarray:
    return np.median(a, axis) / np.median(b, axis)


def _interval(
    samples: tuple[np.ndarray, ...], statistic: Callable, seed: int, resamples: int, paired=False
) -> tuple[float, float, float]:
    low, high = bootstrap(
        samples,
        statistic,
        n_resamples=resamples,
        method="percentile",
        paired=paired,
        rng=np.random.default_rng(seed),
    ).confidence_interval
    return float(statistic(*samples)), float(low), float(high)

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

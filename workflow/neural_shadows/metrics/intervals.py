"""How sure means over views and trainings are: 95 % intervals, percentile bootstrap over views."""

from collections.abc import Callable

import numpy as np
from scipy.stats import bootstrap, t

from neural_shadows.metrics.pooled_psnr import mse_of, psnr_of

LEVEL = 0.95
FEWEST_VIEWS = 10  # a resampling of fewer is far too narrow to decide anything


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


def paired_difference(
    a: np.ndarray, b: np.ndarray, seed: int, resamples: int = 2000
) -> tuple[float, float, float]:
    """Mean difference of two methods on the same views, (n,) each: (a − b, low, high)."""
    return mean_interval(np.subtract(a, b, dtype=np.float64), seed, resamples)


def pooled_psnr_interval(
    psnr: np.ndarray, seed: int, resamples: int = 2000
) -> tuple[float, float, float]:
    """Pooled PSNR of a method's views (n,), dB: (value, low, high); views are drawn."""
    mean, low, high = mean_interval(mse_of(psnr), seed, resamples)
    return tuple(float(psnr_of(mse)) for mse in (mean, high, low))


def pooled_psnr_difference(
    a: np.ndarray, b: np.ndarray, seed: int, resamples: int = 2000
) -> tuple[float, float, float]:
    """Difference of the pooled PSNRs of two methods on the same views, dB: (a − b, low, high).

    Args:
        a, b: PSNR of each view (n,), dB. The same views are drawn of both.
    """
    squares = mse_of(a), mse_of(b)
    if len(squares[0]) == 1:
        return (float(np.subtract(a, b)[0]),) * 3
    return _interval(squares, _psnr_difference, seed, resamples, paired=True)


def t_interval(values: np.ndarray) -> tuple[float, float, float, float]:
    """Mean of one value a training (S,), by Student's t: (mean, low, high, two-sided p of mean 0).

    One training says nothing of how trainings differ: its interval is without ends, and p is 1.
    """
    values = np.asarray(values, dtype=np.float64)
    mean, count = float(values.mean()), values.size
    if count == 1:
        return mean, -np.inf, np.inf, 1.0
    error = values.std(ddof=1) / np.sqrt(count)
    half = float(t.ppf((1 + LEVEL) / 2, count - 1) * error)
    p = float(2 * t.sf(abs(mean) / error, count - 1)) if error else float(mean == 0)
    return mean, mean - half, mean + half, p


def two_way_interval(
    values: np.ndarray,
    seed: int,
    statistic: Callable[[np.ndarray], float] = np.mean,
    groups: np.ndarray | None = None,
    resamples: int = 2000,
) -> tuple[float, float, float, float]:
    """A statistic of trainings and views, and how sure it is of both.

    Views are drawn with replacement, each in place of one of its own group. Trainings are not:
    three can be drawn in ten ways only, none wider than themselves, which covers 77 % where it
    should 95. Their part is drawn from Student's t with S − 1 degrees of freedom instead, with
    the standard deviation of the statistic between the trainings on the drawn views. With one
    training the interval is of its views alone.

    Args:
        values: (S, V) of trainings and views, or (S, V, ...), for instance with both methods of a
            pair. A method without a training, such as a map, is repeated S times.
        statistic: of values with the shape of `values`, whatever S. Columns of a group stay in
            the places of that group.
        groups: (V,) the view set of each view (with two scenes, of which); None: all are of one.

    Returns:
        The statistic, the ends of its 95 % interval, and the two-sided p-value of its being 0,
        which is at least 2 / (resamples + 1).
    """
    values = np.asarray(values, dtype=np.float64)
    trainings, views = values.shape[:2]
    rng = np.random.default_rng(seed)
    labels = np.zeros(views, int) if groups is None else np.unique(groups, return_inverse=True)[1]
    places = np.empty((resamples, views), int)
    for label in range(labels.max() + 1):
        group = np.flatnonzero(labels == label)
        places[:, group] = rng.choice(group, (resamples, len(group)))
    drawn = np.array([statistic(values[:, some]) for some in places])
    if trainings > 1:
        each = [[statistic(one[None, some]) for one in values] for some in places]
        errors = np.std(each, axis=1, ddof=1) / np.sqrt(trainings)
        drawn += errors * rng.standard_t(trainings - 1, resamples)
    low, high = np.quantile(drawn, ((1 - LEVEL) / 2, (1 + LEVEL) / 2))
    fewer = min(np.count_nonzero(drawn <= 0), np.count_nonzero(drawn >= 0))
    p = min(1.0, 2 * (fewer + 1) / (resamples + 1))
    return float(statistic(values)), float(low), float(high), p


def _psnr_difference(a: np.ndarray, b: np.ndarray, axis: int = -1) -> np.ndarray:
    return psnr_of(a.mean(axis) / b.mean(axis))


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

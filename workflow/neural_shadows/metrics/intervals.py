"""95 % intervals of means: views, frames, scenes, trainings.

Means over views of one object: percentile bootstrap, expanded to the width of Student's t. Means
over scenes, and whatever trainings are compared by: Student's t with the degrees of freedom of
Satterthwaite (1946). Simulated coverage of the latter for 5, 10 and 16 scenes of 2 to 6 frames,
with three trainings or none: 93 to 97 % for scenes and frames that differ normally or with a skewness
of up to 1.3 (lognormal, σ 0.4), 88 to 90 % for one of 6.2 (σ 1). Of scenes of which some are of one
kind: 93 to 96 %, where scenes as units had 68 to 95. Of such a skewness 82 to 87 % for 13 scenes of seven kinds,
and 82 % for five scenes; nearly all the rest lies above the interval.
"""

import re
from collections.abc import Callable, Iterable

import numpy as np
import scipy

from neural_shadows.metrics.pooled_psnr import mse_of, psnr_of

LEVEL = 0.95
RESAMPLES = 2000
FEWEST_VIEWS = 10  # views or frames for a decision; of fewer a percentile is a single view
# Kinds of scenes for these to be the units. Of five, 2.8 standard errors either way; of fewer (4: 3.2, 3: 4.3,
# 2: 12.7) nothing is decided for other scenes, and frames are samples of these alone.
FEWEST_SCENES = 5


def mean_interval(
    values: np.ndarray, seed: int, resamples: int = RESAMPLES
) -> tuple[float, float, float]:
    """Mean of `values` (n,) with its interval: (mean, low, high).

    Views are drawn with replacement. The same seed draws the same views for every series of
    the same length, so intervals of methods seen from the same views can be compared. A single
    value has no spread: low = high = mean.
    """
    values = np.asarray(values, dtype=np.float64)
    if values.size == 1:
        return (float(values[0]),) * 3
    return _interval((values,), np.mean, seed, resamples)


def paired_difference(a: np.ndarray, b: np.ndarray, seed: int) -> tuple[float, float, float]:
    """Mean difference on the same views: (a − b, low, high). Of two methods, (n,) each."""
    return mean_interval(np.subtract(a, b, dtype=np.float64), seed)


def pooled_psnr_interval(psnr: np.ndarray, seed: int) -> tuple[float, float, float]:
    """Pooled PSNR of a method's views (n,), dB: (value, low, high). Views are resampled."""
    mean, low, high = mean_interval(mse_of(psnr), seed)
    return tuple(float(psnr_of(mse)) for mse in (mean, high, low))


def pooled_psnr_difference(a: np.ndarray, b: np.ndarray, seed: int) -> tuple[float, float, float]:
    """Difference of pooled PSNRs, dB: (a − b, low, high). Of two methods on the same views.

    Args:
        a, b: PSNR of each view (n,), dB. The same views are drawn of both.
    """
    squares = mse_of(a), mse_of(b)
    if len(squares[0]) == 1:
        return (float(np.subtract(a, b)[0]),) * 3
    return _interval(squares, _psnr_difference, seed, paired=True)


def t_interval(values: np.ndarray) -> tuple[float, float, float, float]:
    """Mean of trainings: (mean, low, high, p).

    One value a training (S,), by Student's t; two-sided p of mean 0. One training has no spread:
    its interval is infinite, and p is 1.
    """
    values = np.asarray(values, dtype=np.float64)
    mean, count = float(values.mean()), values.size
    if count == 1:
        return mean, -np.inf, np.inf, 1.0
    return _students(mean, [(values.var(ddof=1) / count, count - 1)])


def kinds_of(scenes: Iterable[str]) -> list[str]:
    """The kind of each scene: its name without a number, `court` of `court_1` and `court_2`.

    Layouts by one generator have more in common than two scenes.
    """
    return [re.sub(r"_\d+$", "", str(scene)) for scene in scenes]


def scenes_interval(values: np.ndarray, scenes: np.ndarray) -> tuple[float, float, float, float]:
    """Mean over scenes of their frames' means, with its interval. And the p-value of its being 0.

    From `FEWEST_SCENES` kinds on these are the units (see `kinds_of`), of which scenes and frames are
    samples: the statement is about other scenes like these. Of fewer the frames are, each among those
    of its scene: the statement is about these scenes. Every scene has the same weight, however many
    frames it has. Trainings are as in `two_way_interval`.

    Args:
        values: (..., S, F) of trainings and frames; leading axes are data of their own.
        scenes: (F,), the scene of each frame.

    Returns:
        Arrays of the leading axes, or numbers; see `two_way_interval`.
    """
    values, scenes = np.asarray(values, np.float64), np.asarray(scenes)
    names = np.unique(scenes)
    by_scene = [values[..., scenes == name] for name in names]
    means = np.stack([frames.mean(axis=-1) for frames in by_scene], axis=-1)
    trainings, count = means.shape[-2:]
    kinds = np.array(kinds_of(names))
    if len(np.unique(kinds)) >= FEWEST_SCENES:
        parts = [_variance_by_kind(means.mean(axis=-2), kinds)]
    else:
        parts = [_variance_of_mean(frames.mean(axis=-2), count) for frames in by_scene]
    if trainings > 1:
        parts.append((means.mean(axis=-1).var(axis=-1, ddof=1) / trainings, trainings - 1))
    return _students(means.mean(axis=(-2, -1)), parts)


def _variance_by_kind(means: np.ndarray, kinds: np.ndarray) -> tuple[np.ndarray, float]:
    """Variance and degrees of freedom of the mean of scenes, (..., scenes).

    Of clusters (Liang and Zeger 1986); as many units as kinds of one size would be.
    """
    off = means - means.mean(axis=-1, keepdims=True)
    sums = np.stack([off[..., kinds == kind].sum(axis=-1) for kind in np.unique(kinds)], axis=-1)
    sizes, count = np.unique(kinds, return_counts=True)[1], sums.shape[-1]
    variance = np.square(sums).sum(axis=-1) * count / (count - 1) / len(kinds) ** 2
    return variance, len(kinds) ** 2 / np.square(sizes).sum() - 1


def _variance_of_mean(frames: np.ndarray, scenes: int) -> tuple[np.ndarray, int]:
    """Variance and degrees of freedom of a scene's mean.

    Its part in the mean over `scenes`; infinite of one frame.
    """
    count = frames.shape[-1]
    if count == 1:
        return np.full(frames.shape[:-1], np.inf), 1
    return frames.var(axis=-1, ddof=1) / count / scenes**2, count - 1


def two_way_interval(
    values: np.ndarray,
    statistic: Callable[[np.ndarray], float] = np.mean,
    groups: np.ndarray | None = None,
) -> tuple[float, float, float, float]:
    """A statistic of trainings and views, with its interval.

    The interval is for both, by Student's t. The variance of views is that of the jackknife, each
    view left out among those of its group (exact for means); that of trainings is of the statistic
    of each. Both are added, with the degrees of freedom of Satterthwaite; what views and trainings
    do together is counted in both. With one training the interval is of its views alone.

    Args:
        values: (S, V) of trainings and views, or (S, V, ...), for instance with both methods of a
            pair. A method without a training, such as a map, is repeated S times.
        statistic: of values with the shape of `values`, whatever S; a function of means or sums over
            the columns of a group, which stay in their places.
        groups: (V,) the view set of each view (with two objects, of which); None: all are of one.

    Returns:
        The statistic, the ends of its 95 % interval (infinite if a group has a single view), and the
        two-sided p-value of its being 0.
    """
    values = np.asarray(values, dtype=np.float64)
    trainings, views = values.shape[:2]
    labels = np.zeros(views, int) if groups is None else np.unique(groups, return_inverse=True)[1]
    influences, value = np.zeros(views), statistic(values)
    each = np.array([statistic(training[None]) for training in values])
    parts = []  # variance and degrees of freedom
    for label in range(labels.max() + 1):
        group = np.flatnonzero(labels == label)
        if len(group) == 1:
            return float(value), -np.inf, np.inf, 1.0
        for training, of_training in zip(values, each):
            total = training[group].sum(axis=0)
            for view in group:
                without = training.copy()
                without[view] = (total - training[view]) / (len(group) - 1)
                influences[view] += (
                    (len(group) - 1) * (of_training - statistic(without[None])) / trainings
                )
        parts.append((influences[group].var(ddof=1) / len(group), len(group) - 1))
    if trainings > 1:
        parts.append((each.var(ddof=1) / trainings, trainings - 1))
    return _students(value, parts)


def _students(
    value: np.ndarray, parts: list[tuple[np.ndarray, float]]
) -> tuple[float, float, float, float]:
    """A value, its interval and p-value.

    From independent variances with their degrees of freedom.
    """
    variance = np.asarray(sum(part for part, _ in parts))
    if not np.isfinite(variance).all():
        unknown = [np.full(np.shape(value), number) for number in (-np.inf, np.inf, 1.0)]
        return (value, *unknown) if np.ndim(value) else (float(value), *map(float, unknown))
    positive = np.where(variance > 0, variance, 1.0)
    freedom = positive**2 / sum((part**2 + (variance <= 0)) / degrees for part, degrees in parts)
    half = scipy.stats.t.ppf((1 + LEVEL) / 2, freedom) * np.sqrt(variance)
    p = np.where(
        variance > 0, 2 * scipy.stats.t.sf(np.abs(value) / np.sqrt(positive), freedom), value == 0
    )
    interval = value, value - half, value + half, p
    return interval if np.ndim(value) else tuple(map(float, interval))


def _psnr_difference(a: np.ndarray, b: np.ndarray, axis: int = -1) -> np.ndarray:
    return psnr_of(a.mean(axis) / b.mean(axis))


def _interval(
    samples: tuple[np.ndarray, ...],
    statistic: Callable,
    seed: int,
    resamples: int = RESAMPLES,
    paired: bool = False,
) -> tuple[float, float, float]:
    low, high = scipy.stats.bootstrap(
        samples,
        statistic,
        n_resamples=resamples,
        confidence_level=_expanded(len(samples[0])),
        method="percentile",
        paired=paired,
        rng=np.random.default_rng(seed),
    ).confidence_interval
    return float(statistic(*samples)), float(low), float(high)


def _expanded(count: int) -> float:
    """Bootstrap level that reaches as far as Student's t.

    Of percentiles of resampled means of `count` values. A resampling has the variance of `count` −
    1 values, without their uncertainty; at `LEVEL` its percentiles cover 90 % for ten values, 92
    for 16 (Hesterberg 2015, section 5.3).
    """
    ends = np.sqrt(count / (count - 1)) * scipy.stats.t.ppf((1 + LEVEL) / 2, count - 1)
    return float(1 - 2 * scipy.stats.norm.sf(ends))

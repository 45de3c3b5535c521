"""Power law of an error over training samples, and extrapolation. m(N) = m∞ + a N^−b.

A power law with offset describes learning curves (e.g. Hestness et al. 2017), and fits any few
budgets well. It extrapolates only after predicting the largest budget from the others.

Errors are positive: loss and LPIPS as they are, PSNR as mean squared error, SSIM as 1 − SSIM.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy

from neural_shadows.metrics.intervals import t_interval
from neural_shadows.metrics.pooled_psnr import psnr_of

EXPONENTS = np.linspace(0.05, 1, 39)  # values of b in the search
LARGEST_STEP = 30  # from the largest budget to the one that is extrapolated to
LARGEST_MISS = 0.1  # of a hold-out; seeds that differ much have wide intervals
LEVEL = 0.9  # of the predictions' intervals
FEWEST_BUDGETS = 3  # the law's number of parameters
RESAMPLES = 1000


@dataclass(frozen=True)
class Curve:
    """Errors > 0 of trainings at growing budgets.

    `values` (K, S) of S seeds at each of K budgets `samples` (K,). A column has one seed. Budgets
    grow; a column has the same seed throughout.
    """

    samples: np.ndarray
    values: np.ndarray


@dataclass(frozen=True)
class PowerLaw:
    """m(N) = offset + factor · (N / unit)^−exponent."""

    offset: float
    factor: float
    exponent: float
    unit: float

    def __call__(self, samples: np.ndarray) -> np.ndarray:
        """Errors at numbers of samples, of any shape."""
        return self.offset + self.factor * (np.asarray(samples) / self.unit) ** -self.exponent


@dataclass(frozen=True)
class HoldOut:
    """The largest budget's error, predicted from the others and measured. Means over seeds.

    low, high: 90 % interval of the prediction, for a mean over this number of seeds; NaN of one seed.
    step: ratio of the samples to those of the budget before.
    """

    predicted: float
    low: float
    high: float
    measured: float
    step: float

    @property
    def error(self) -> float:
        """Relative error of the prediction."""
        return self.predicted / self.measured - 1

    @property
    def failure(self) -> str:
        """Reason to refuse an extrapolation, or an empty string.

        The measured error is outside the interval, or the prediction misses by too much.
        """
        missed = f"the hold-out is missed by {100 * self.error:+.1f} %"
        if not self.low <= self.measured <= self.high:
            return f"{missed}, outside its interval"
        return f"{missed}, {100 * LARGEST_MISS:.0f} % at most" * (abs(self.error) > LARGEST_MISS)


def fit(curve: Curve) -> PowerLaw:
    """Power law of a curve's means over seeds. b in [0.05, 1] and m∞ ≥ 0.

    By least relative squares; of the laws with and without m∞ that of the lower AIC, with the
    spread of the seeds as the means' uncertainty. With one seed it is the law without m∞.

    Raises:
        ValueError: there are fewer than two budgets, or errors that are no positive numbers.
    """
    means, spread = _means(curve)
    law = _fit(curve.samples, means[None], spread)
    return PowerLaw(*(float(value[0]) for value in law), unit=float(curve.samples[-1]))


def hold_out(curve: Curve, seed: int) -> HoldOut:
    """Predict the largest budget of a curve from the others. `seed` is of the bootstrap.

    Raises:
        ValueError: there are fewer than three budgets, or errors that are no positive numbers.
    """
    others = Curve(curve.samples[:-1], curve.values[:-1])
    predicted, drawn, noise = _extrapolated(others, curve.samples[-1], seed)
    low, high = _ends(drawn * noise)
    step = float(curve.samples[-1] / curve.samples[-2])
    return HoldOut(predicted, low, high, float(np.mean(curve.values[-1])), step)


def extrapolate(curve: Curve, samples: float, seed: int) -> tuple[float, float, float]:
    """Expected error at a number of samples: (value, low, high).

    90 % interval; ends are NaN of one seed.

    Raises:
        ValueError: as `fit`.
    """
    value, drawn, _ = _extrapolated(curve, samples, seed)
    return value, *_ends(drawn)


def extrapolate_difference(
    a: Curve | float, b: Curve | float, samples: float, seed: int, psnr: bool = False
) -> tuple[float, float, float]:
    """Expected a − b at a number of samples: (value, low, high).

    90 % interval; ends are NaN of one seed. The same seeds and budgets are drawn of both, so that
    what they have in common cancels.

    Args:
        a, b: of the same numbers of budgets and seeds; a number is the error of a method
            without training, such as a shadow map.
        psnr: the curves are of mean squared errors, and the difference is of PSNRs, dB.

    Raises:
        ValueError: as `fit`.
    """
    difference = _psnr_difference if psnr else np.subtract
    (value_a, drawn_a, _), (value_b, drawn_b, _) = (
        _extrapolated(curve, samples, seed) if isinstance(curve, Curve) else (curve, curve, 1.0)
        for curve in (a, b)
    )
    return float(difference(value_a, value_b)), *_ends(difference(drawn_a, drawn_b))


def licensed(
    curves: Sequence[Curve], samples: float, seed: int, diverged: bool = False
) -> tuple[bool, str]:
    """Permit or refuse extrapolation to a number of samples.

    The reason is empty if it is allowed. Allowed if each predicts its largest budget from the
    others, within its 90 % interval and to 10 %, the step is at most thirtyfold, and none of their
    trainings `diverged`.
    """
    if diverged:
        return False, "a training diverged"
    reasons = []
    for curve in curves:
        if len(curve.samples) < FEWEST_BUDGETS:
            return False, f"{len(curve.samples)} budgets: {FEWEST_BUDGETS} are needed"
        if not can_hold_out(curve):
            return False, "an error of 0 has no power law"
        if curve.values.shape[1] == 1:
            return False, "one seed gives no uncertainty of the fit"
        reasons += filter(None, [hold_out(curve, seed).failure])
    step = samples / min(curve.samples[-1] for curve in curves)
    if step > LARGEST_STEP:
        reasons.append(f"{step:,.0f} times the largest budget, {LARGEST_STEP} at most")
    return not reasons, "; ".join(dict.fromkeys(reasons))


def can_hold_out(curve: Curve) -> bool:
    """Check for enough budgets and for positive errors."""
    return len(curve.samples) >= FEWEST_BUDGETS and _positive(curve.values)


def local_exponents(curve: Curve) -> np.ndarray:
    """−d log m / d log N between consecutive budgets, (K − 1,).

    Of a power law without offset it is b.
    """
    means = np.mean(curve.values, axis=1)
    return -np.diff(np.log(means)) / np.diff(np.log(curve.samples))


def trend(samples: np.ndarray, differences: np.ndarray) -> tuple[float, float, float]:
    """Slope of differences over log10 of samples: (slope, low, high).

    Of differences (K, S) of two arms, samples (K,). A slope is fitted to each seed; 95 % by
    Student's t over the seeds, without ends of one seed.
    """
    slopes = np.polyfit(np.log10(samples), differences, 1)[0]
    return t_interval(slopes)[:3]


def _positive(values: np.ndarray) -> bool:
    return bool(np.all(np.isfinite(values) & (np.asarray(values) > 0)))


def _means(curve: Curve) -> tuple[np.ndarray, float]:
    """Means over seeds (K,), and their logarithmic standard deviation. NaN of one seed."""
    if len(curve.samples) < 2 or not _positive(curve.values):
        raise ValueError("a power law needs two budgets or more, and errors that are positive")
    seeds = curve.values.shape[1]
    residuals = _residuals(curve)
    freedom = len(residuals) * (seeds - 1)
    spread = np.sqrt(np.sum(residuals**2) / freedom / seeds) if freedom else np.nan
    return curve.values.mean(axis=1), float(spread)


def _residuals(curve: Curve) -> np.ndarray:
    """Logarithmic residuals from each budget's mean, (K, S)."""
    logs = np.log(curve.values)
    return logs - logs.mean(axis=1, keepdims=True)


def _fit(
    samples: np.ndarray, means: np.ndarray, spread: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Offset, factor and exponent, (R,) each, of R series.

    Means are (R, K); factors are those at samples[-1]. By variable projection: for each b the law
    is linear in m∞ and a.
    """
    x = samples / samples[-1]
    bare, full = (_best(x, means, offset) for offset in (False, True))
    # The law with an offset has one parameter more, for which it must gain 2 in −2 log likelihood. It
    # is left out where the means have no known spread.
    better = (bare[0] - full[0] > 2 * spread**2) & (len(samples) >= FEWEST_BUDGETS)
    return tuple(
        np.where(better, with_offset, without) for with_offset, without in zip(full[1:], bare[1:])
    )


def _best(
    x: np.ndarray, means: np.ndarray, offset: bool
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Sum of squares, offset, factor and exponent, (R,) each. Of the best b in [0.05, 1]."""
    squares = _linear(x, means, EXPONENTS[None], offset)[0]
    # The vertex of the parabola through the least square and its neighbours: the step of b alone
    # would be 3 % of what is extrapolated thirtyfold.
    least = squares.argmin(axis=1).clip(1, len(EXPONENTS) - 2)
    below, at, above = (squares[np.arange(len(means)), least + i] for i in (-1, 0, 1))
    with np.errstate(divide="ignore", invalid="ignore"):
        shift = np.nan_to_num((below - above) / (below - 2 * at + above) / 2)
    exponent = EXPONENTS[least] + shift * (EXPONENTS[1] - EXPONENTS[0])
    exponent = exponent.clip(EXPONENTS[0], EXPONENTS[-1])
    solved = _linear(x, means, exponent[:, None], offset)
    return *(solution[:, 0] for solution in solved), exponent


def _linear(
    x: np.ndarray, means: np.ndarray, exponents: np.ndarray, offset: bool
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Sum of squared relative residuals, m∞ and a, (R, B). For b of (R or 1, B)."""
    power = x ** -exponents[..., None]  # (R or 1, B, K)
    u = 1 / means  # residuals are those of m∞ · u + a · power · u = 1
    xu, xxu2, xu2 = (
        (base @ weight[..., None])[..., 0]
        for base, weight in ((power, u), (power**2, u**2), (power, u**2))
    )
    constant, slope = np.zeros_like(xu), xu / xxu2
    u1, u2 = u.sum(axis=1, keepdims=True), (u**2).sum(axis=1, keepdims=True)
    if offset:
        determinant = u2 * xxu2 - xu2**2
        free = (u1 * xxu2 - xu * xu2) / determinant
        slope = np.where(free > 0, (u2 * xu - xu2 * u1) / determinant, slope)
        constant = free.clip(0)
    return len(x) - constant * u1 - slope * xu, constant, slope  # what least squares leave


def _extrapolated(curve: Curve, samples: float, seed: int) -> tuple[float, np.ndarray, np.ndarray]:
    """Extrapolated error, its resamples (R,), and the seeds' noise (R,).

    Each resampling draws for every budget S of all residuals, and chooses its law anew. The noise,
    (R,), is the factor of a mean over S further seeds. Residuals are widened for what their few
    means took of them, and for the tails of Student's t. All is NaN of one seed.
    """
    means, spread = _means(curve)
    budgets, seeds = curve.values.shape
    value = float(fit(curve)(samples))
    if seeds == 1:
        return value, np.array([np.nan]), np.array([np.nan])
    freedom = budgets * (seeds - 1)
    quantile = (1 + LEVEL) / 2
    wide = (
        np.sqrt(seeds / (seeds - 1))
        * scipy.stats.t.ppf(quantile, freedom)
        / scipy.stats.norm.ppf(quantile)
    )
    rng = np.random.default_rng(seed)
    residuals = wide * _residuals(curve).ravel()
    drawn = rng.choice(residuals, (RESAMPLES, budgets + 1, seeds)).mean(axis=2)
    noise = np.exp(drawn[:, -1])
    offset, factor, exponent = _fit(curve.samples, means * np.exp(drawn[:, :-1]), spread)
    return value, offset + factor * (samples / curve.samples[-1]) ** -exponent, noise


def _ends(drawn: np.ndarray) -> tuple[float, float]:
    low, high = np.quantile(drawn, ((1 - LEVEL) / 2, (1 + LEVEL) / 2))
    return float(low), float(high)


def _psnr_difference(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return psnr_of(np.divide(a, b))

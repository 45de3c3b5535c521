"""The trend of two methods' difference over training samples."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy

from neural_shadows.metrics import power_law
from neural_shadows.metrics.intervals import LEVEL
from neural_shadows.metrics.pooled_psnr import psnr_of
from neural_shadows.metrics.power_law import Curve
from neural_shadows.reports.claims.measured import Measured
from neural_shadows.reports.data.digits import short
from neural_shadows.reports.data.trained import THESIS_SAMPLES, Budget, Row

TOWARDS, AWAY, NEITHER = "towards", "away", "neither"


@dataclass(frozen=True)
class Learning:
    """A difference over learning curves, positive in the claim's favour.

    Args:
        trend: its change for each tenfold of the samples, and the 95 % interval over seeds.
        relative: the same of the logarithm of the errors' ratio.
        extrapolated: at the thesis's samples, with 95 % interval and two-sided p-value; None if the
            curves do not license it, for the reason `unlicensed`.
        steps: the thesis's samples over those of the largest budget, and these over those of the
            second largest, the step of the hold-out.
    """

    trend: tuple[float, float, float]
    relative: tuple[float, float, float]
    extrapolated: tuple[float, float, float, float] | None
    unlicensed: str
    steps: tuple[float, float]

    @property
    def direction(self) -> str:
        """Towards the claim, away from it, or neither.

        Empty for one seed. Any gap closes while both errors fall, and opens while they do not: from
        5 to 20 million samples that of 10 frequencies to none fell from 0.049 to 0.044 in loss, and
        their ratio grew from 1.28 to 1.40. So both must agree.
        """
        _, lows, highs = zip(self.trend, self.relative)
        if not np.isfinite(lows).all():
            return ""
        return TOWARDS if min(lows) > 0 else AWAY if max(highs) < 0 else NEITHER

    @property
    def text(self) -> str:
        """Trend and extrapolation in words and numbers."""
        value, low, high = self.trend
        ends = f" [{low:+.3g}, {high:+.3g}]" if self.direction else ""
        text = f"trend {value:+.3g}{ends} for each tenfold of the samples"
        if self.extrapolated:
            at, below, above, _ = self.extrapolated
            step, held_out_step = self.steps
            text += (
                f", at the thesis's samples {at:+.3g} [{below:+.3g}, {above:+.3g}] ({short(step)} "
                f"times the largest budget, the hold-out tries {short(held_out_step)} times)"
            )
        return text


def follow(
    pair: Sequence[Row],
    budgets: Sequence[Budget],
    errors: Sequence[Sequence[np.ndarray]],
    data: Measured,
    psnr: bool = False,
    views: tuple[float, float] = (0.0, 0.0),
) -> Learning | None:
    """Follow the advantage of a pair's first method over budgets.

    None for fewer than `FEWEST_BUDGETS`. Diverged trainings are on no curve.

    Args:
        errors: of the trainings, by method and budget.
        psnr: the errors are squared ones, and the advantage is in dB.
        views: distances from the advantage down and up to the ends of its 95 % interval over views.
    """
    if budgets[-1].samples is None or len(budgets) < power_law.FEWEST_BUDGETS:
        return None
    samples = np.array([budget.samples for budget in budgets])
    a, b = (Curve(samples, np.array(each)) for each in errors)
    gaps = psnr_of(a.values) - psnr_of(b.values) if psnr else b.values - a.values
    trend = power_law.trend(samples, gaps)
    # An error may be 0, of a frame equal to its reference: 1e-10, as in PSNR.
    ratios = np.log(np.maximum(b.values, 1e-10) / np.maximum(a.values, 1e-10))
    relative = power_law.trend(samples, ratios)
    steps = THESIS_SAMPLES / samples[-1], samples[-1] / samples[-2]
    curves = [curve for curve, row in zip((a, b), pair) if row["trained"]]
    diverged = any(data.diverged(row, budgets) for row in pair)
    licensed, reason = power_law.licensed(curves, THESIS_SAMPLES, data.seed, diverged)
    if not licensed:
        return Learning(trend, relative, None, reason, steps)
    # A map's errors are the same at all budgets.
    arms = [
        curve if row["trained"] else curve.values[-1].mean() for curve, row in zip((a, b), pair)
    ]
    arms = arms if psnr else arms[::-1]
    difference = power_law.extrapolate_difference(*arms, THESIS_SAMPLES, data.seed, psnr)
    return Learning(trend, relative, widened(difference, views), "", steps)


def widened(
    difference: tuple[float, float, float], views: tuple[float, float]
) -> tuple[float, float, float, float]:
    """Widen an extrapolated value's interval by the views' interval.

    Each side is scaled from 90 % and widened separately: values near a floor are skewed. Errors of
    fits and of views are taken as independent, and each side as that of a normal distribution.

    Args:
        difference: a value and its 90 % interval over seeds alone.
        views: lengths of the 95 % interval over views alone, down and up.

    Returns: the value, the ends of its 95 % interval and its two-sided p-value.
    """
    value, low, high = difference
    z_95, z_90 = (scipy.stats.norm.ppf((1 + level) / 2) for level in (LEVEL, power_law.LEVEL))
    # The value may lie outside its interval, which is of resampled fits.
    sides = np.maximum([value - low, high - value], 0.0) * z_95 / z_90
    down, up = np.hypot(sides, views)
    towards_0 = down if value > 0 else up
    if not towards_0:
        p = float(value == 0)
    else:
        p = float(2 * scipy.stats.norm.sf(z_95 * abs(value) / towards_0))
    return value, float(value - down), float(value + up), p

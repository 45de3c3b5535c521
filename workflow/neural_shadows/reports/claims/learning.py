"""Where a difference of two methods goes as their networks are trained on more samples."""

from dataclasses import dataclass

import numpy as np
from scipy.stats import norm

from neural_shadows.metrics import power_law
from neural_shadows.metrics.intervals import LEVEL
from neural_shadows.metrics.pooled_psnr import psnr_of
from neural_shadows.metrics.power_law import Curve
from neural_shadows.reports.claims.measured import THESIS_SAMPLES

TOWARDS, AWAY, NEITHER = "towards", "away", "neither"


@dataclass(frozen=True)
class Learning:
    """What learning curves say of a difference, positive in the claim's favour.

    Args:
        trend: its change for each tenfold of the samples, and the 95 % interval over seeds.
        relative: the same of the logarithm of the errors' ratio.
        extrapolated: it at the thesis's samples, its 95 % interval and two-sided p-value; None if
            the curves do not license it, for the reason `unlicensed`.
    """

    trend: tuple[float, float, float]
    relative: tuple[float, float, float]
    extrapolated: tuple[float, float, float, float] | None
    unlicensed: str

    @property
    def direction(self) -> str:
        """Towards the claim, away from it, or neither; empty of one seed.

        Any gap closes while both errors fall, and opens while they do not: from 5 to 20 million
        samples that of 10 frequencies to none fell from 0.049 to 0.044 in loss, and their ratio
        grew from 1.28 to 1.40. So both must agree.
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
        said = f"trend {value:+.3g}{ends} for each tenfold of the samples"
        if self.extrapolated:
            at, below, above, _ = self.extrapolated
            said += f", at the thesis's samples {at:+.3g} [{below:+.3g}, {above:+.3g}]"
        return said


def followed(
    a: Curve, b: Curve, trained: list[Curve], *, psnr: bool, views: float, seed: int
) -> Learning:
    """Follow the advantage of `a` over `b`.

    Args:
        a, b: errors of both methods at the same budgets, `FEWEST_BUDGETS` or more, and seeds; a map's are all the same.
        trained: those of the two that are of networks.
        psnr: the errors are squared ones, and the advantage is in dB.
        views: half the 95 % interval of the advantage over views alone, in its unit.
        seed: of the resampling of curves.
    """
    gaps = psnr_of(a.values) - psnr_of(b.values) if psnr else b.values - a.values
    trend = power_law.trend(a.samples, gaps)
    # An error may be 0, that of a frame like its reference: 1e-10, as in PSNR.
    ratios = np.log(np.maximum(b.values, 1e-10) / np.maximum(a.values, 1e-10))
    relative = power_law.trend(a.samples, ratios)
    allowed, why = power_law.licensed(trained, THESIS_SAMPLES, seed)
    if not allowed:
        return Learning(trend, relative, None, why)
    arms = (a, b) if psnr else (b, a)
    value, low, high = power_law.extrapolate_difference(*arms, THESIS_SAMPLES, seed, psnr)
    # The fits know nothing of other views. Both errors are taken as normal and independent.
    wide = norm.ppf((1 + LEVEL) / 2)
    half = float(np.hypot((high - low) / 2 * wide / norm.ppf((1 + power_law.LEVEL) / 2), views))
    p = float(2 * norm.sf(wide * abs(value) / half)) if half else float(value == 0)
    return Learning(trend, relative, (value, value - half, value + half, p), "")

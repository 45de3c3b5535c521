"""One comparison of a claim, and the verdict of all."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from neural_shadows.metrics.holm import holm
from neural_shadows.reports.claims.learning import Learning
from neural_shadows.reports.data.frame_means import OFF_EDGES
from neural_shadows.reports.data.verdicts import CONTRADICTED, SUPPORTED, UNDECIDED

LEVEL = 0.05
NAMES = {
    "lpips": "LPIPS",
    "psnr": "PSNR",
    "ssim": "SSIM",
    "flip": "FLIP",
    "shadow_error": "shadow error",
    "loss": "loss",
    "mse": "MSE × 10⁻⁴",
    "mse_off_edges": "MSE × 10⁻⁴ off edges",
    "l1": "L1 in %",
    "light_leak": "light leak in %",
    "false_shadow": "false shadow in %",
}


@dataclass(frozen=True)
class Comparison:
    """The outcome of one comparison of a claim.

    Args:
        metric, methods: what is compared, and of which methods.
        text: the methods and their values.
        number: the advantage, or what else is judged, and its interval, as text; empty if there is
            too little for one. remark: what follows it.
        supports: its interval lies wholly on the claim's side.
        against: p-value of its lying on the claim's side in truth; 1 if it does as measured.
        seeds, samples: of the trainings that it compares; None if nothing is trained.
        learning: over the learning curves, if there are any.
        incomparable: why the methods cannot be compared, if they cannot.
        untested: what there is too little of for a test, if there is.
    """

    metric: str
    methods: str
    text: str
    number: str
    supports: bool
    against: float
    seeds: int | None = None
    samples: int | None = None
    learning: Learning | None = None
    incomparable: str = ""
    untested: str = ""
    remark: str = ""

    @property
    def evidence(self) -> str:
        """The comparison in words and numbers."""
        trend = f", {self.learning.text}" if self.learning else ""
        return f"{self.text}: {self.number}{self.remark}{trend}"

    @property
    def extrapolated(self) -> "Comparison | None":
        """The same at the thesis's samples; None without a licence."""
        if self.learning is None or self.learning.extrapolated is None:
            return None
        return replace(self, **judged(*self.learning.extrapolated))


def unjudged(**why: str) -> dict[str, object]:
    """Fields of an undecided `Comparison` for a reason."""
    (reason,) = why.values()
    return {"number": "", "remark": reason, "supports": False, "against": 1.0, **why}


def judged(value: float, low: float, high: float, p: float) -> dict[str, object]:
    """Fields of a `Comparison` by the interval of an advantage.

    The interval is the 95 % one, p two-sided. 0 itself is neither side: methods that are alike in
    every view decide nothing.
    """
    return {
        "number": interval_text(value, low, high),
        "supports": low > 0,
        "against": p if value < 0 else 1.0,
    }


def interval_text(value: float, low: float, high: float) -> str:
    """An advantage with three digits and its interval, if any."""
    if not low > -float("inf"):
        return f"{value:+.3g}"
    return f"{value:+.3g} [{low:+.3g}, {high:+.3g}]"


def seeds_of(count: int, needed: int) -> str:
    """The number of seeds beside the needed one."""
    return f"{count} seed{'s' if count > 1 else ''} of {needed}"


def of_all_pixels(metric: str) -> str:
    """The metric of all pixels for one off edges."""
    return metric.removesuffix(OFF_EDGES.removeprefix("mse"))


def verdict_of(comparisons: Sequence[Comparison]) -> str:
    """The verdict of all comparisons together.

    All must hold for a support, so that none needs a correction (intersection-union test); a claim
    is contradicted if Holm's correction leaves a comparison against it.
    """
    if all(comparison.supports for comparison in comparisons):
        return SUPPORTED
    return CONTRADICTED if against(comparisons) else UNDECIDED


def against(comparisons: Sequence[Comparison]) -> list[Comparison]:
    """The comparisons against a claim by Holm's correction over all."""
    adjusted = holm([comparison.against for comparison in comparisons])
    return [comparison for comparison, p in zip(comparisons, adjusted) if p <= LEVEL]


def most_against(comparisons: Sequence[Comparison]) -> Comparison | None:
    """The comparison most against a claim, if any.

    That of the least p-value: the one that contradicts it, if one does. Of those that lie on the
    claim's side the first that does not support it.
    """
    numbered = [comparison for comparison in comparisons if comparison.number]
    return min(numbered, key=lambda each: (each.against, each.supports), default=None)

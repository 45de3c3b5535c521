"""One comparison of a claim, and what all of a claim's comparisons say together."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from neural_shadows.metrics.holm import holm
from neural_shadows.reports.claims.learning import Learning
from neural_shadows.reports.verdicts import CONTRADICTED, SUPPORTED, UNDECIDED

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
    """How one comparison of a claim came out.

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
        learnt = f", {self.learning.text}" if self.learning else ""
        return f"{self.text}: {self.number}{self.remark}{learnt}"

    @property
    def extrapolated(self) -> "Comparison | None":
        """The same at the thesis's samples; None if the learning curves do not license it."""
        if self.learning is None or self.learning.extrapolated is None:
            return None
        return replace(self, **judged(*self.learning.extrapolated))


def unjudged(**why: str) -> dict[str, object]:
    """What says nothing, as a `Comparison` has it; `why`: its `incomparable` or `untested`."""
    (said,) = why.values()
    return {"number": "", "remark": said, "supports": False, "against": 1.0, **why}


def judged(value: float, low: float, high: float, p: float) -> dict[str, object]:
    """What an advantage, its 95 % interval and its two-sided p-value say, as a `Comparison` has it.

    0 itself is neither side: methods that are alike in every view decide nothing.
    """
    return {
        "number": interval_text(value, low, high),
        "supports": low > 0,
        "against": p if value < 0 else 1.0,
    }


def interval_text(value: float, low: float, high: float) -> str:
    """An advantage with three digits and its interval; without one where none can be had."""
    if not low > -float("inf"):
        return f"{value:+.3g}"
    return f"{value:+.3g} [{low:+.3g}, {high:+.3g}]"


def verdict_of(comparisons: Sequence[Comparison]) -> str:
    """Supported if each comparison supports the claim, contradicted if Holm leaves one against it.

    All must hold for a support, so that none needs a correction (intersection-union test).
    """
    if all(comparison.supports for comparison in comparisons):
        return SUPPORTED
    return CONTRADICTED if against(comparisons) else UNDECIDED


def against(comparisons: Sequence[Comparison]) -> list[Comparison]:
    """The comparisons that contradict a claim, by Holm's correction over all of them."""
    adjusted = holm([comparison.against for comparison in comparisons])
    return [one for one, p in zip(comparisons, adjusted) if p <= LEVEL]


def most_against(comparisons: Sequence[Comparison]) -> Comparison | None:
    """The comparison with a number that speaks most against a claim; None if none has a number.

    That of the least p-value: the one that contradicts it, if one does. Of those that lie on the
    claim's side the first that does not support it.
    """
    known = [one for one in comparisons if one.number]
    return min(known, key=lambda one: (one.against, one.supports), default=None)

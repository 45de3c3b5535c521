"""One comparison of a claim, and the verdict of all."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from neural_shadows.metrics.holm import holm
from neural_shadows.metrics.registry import metrics
from neural_shadows.reports.claims.learning import Learning
from neural_shadows.reports.data.frame_means import OFF_EDGES
from neural_shadows.reports.data.verdicts import CONTRADICTED, SUPPORTED, UNDECIDED

LEVEL = 0.05


@dataclass(frozen=True)
class Comparison:
    """The outcome of one comparison of a claim.

    Args:
        metric, methods: of the comparison.
        text: the methods and their values.
        number: the advantage or another judged value with its interval, as text; empty without
            enough data. remark: text behind it.
        supports: its interval lies wholly on the claim's side.
        against: p-value of the true advantage on the claim's side; 1 if the measured one is there. It decides
            nothing where `untested`.
        seeds, samples: of the compared trainings; None without any.
        learning: over the learning curves, if any.
        incomparable: reason against a comparison of the methods, if any.
        untested: data missing for a test, if any.
    """

    metric: str
    methods: str
    text: str
    number: str = ""
    supports: bool = False
    against: float = 1.0
    seeds: int | None = None
    samples: int | None = None
    learning: Learning | None = None
    incomparable: str = ""
    untested: str = ""
    remark: str = ""

    @property
    def metric_name(self) -> str:
        """The metric in words, or the column of a table."""
        metric = metrics().get(self.metric)
        return metric.text if metric else self.metric

    @property
    def evidence(self) -> str:
        """The comparison in words and numbers."""
        trend = f", {self.learning.text}" if self.learning else ""
        number = self.number or self.untested or self.incomparable
        return f"{self.text}: {number}{self.remark}{trend}"

    @property
    def extrapolated(self) -> "Comparison | None":
        """The same at the thesis's samples; None without a licence."""
        if self.learning is None or self.learning.extrapolated is None:
            return None
        return replace(self, **judged(*self.learning.extrapolated))

    def without(self, missing: str) -> "Comparison":
        """The same undecided for missing data."""
        return replace(self, supports=False, untested=missing)


def judged(value: float, low: float, high: float, p: float) -> dict[str, object]:
    """Fields of a `Comparison` by the interval of an advantage.

    The interval is the 95 % one, p two-sided. 0 is on neither side: equal methods decide
    nothing.
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
    return metric.replace(OFF_EDGES.removeprefix("mse"), "")


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
    adjusted = holm([1.0 if each.untested else each.against for each in comparisons])
    return [comparison for comparison, p in zip(comparisons, adjusted) if p <= LEVEL]


def most_against(comparisons: Sequence[Comparison]) -> Comparison | None:
    """The comparison most against a claim, if any.

    The one with the least p-value, which contradicts the claim if any does. Among those on the
    claim's side the first without support.
    """
    numbered = [comparison for comparison in comparisons if comparison.number]
    return min(numbered, key=lambda each: (each.against, each.supports), default=None)

"""The interface of a claim's kind, a module of `kinds/`.

Each has
    Settings: the model of its section.
    files(layout, claim): paths by argument of `write_claims.claims`.
    comparisons(claim, data): a list of `Comparison`.
Where it applies, it has
    compared(claim): rows of methods on scenes' viewpoints, by comparison.
    without_networks(claim, data): comparisons with null predictors for networks, by null predictor.
    network_wins(claim): a network is a claimed winner; True in kinds without this function.
    not_comparable(claim, data): reason against comparable measurements, or "".
    not_learned(claim, row, budget, data): evidence that a row has not learned, or "".
    by_all_pixels(claim): the claim on errors of all pixels, or None without errors off edges.
    counts_by_view(metrics): values beside image metrics, a row a view.
    NEEDS_SEEDS: it compares trainings and needs several seeds.
    COUNTS_VIOLATIONS: it counts violations of depth bounds.
    OF_SOFT_METHODS: its `table` is of methods for soft shadows.
"""

from collections.abc import Sequence
from types import ModuleType
from typing import Any

from neural_shadows.reports.claims.measured import Claim
from neural_shadows.reports.data.trained import Row
from neural_shadows.settings.kinds import kinds


def kind_of(claim: Claim) -> ModuleType:
    """The module of a claim's kind."""
    return kinds("reports/claims/kinds")[claim["kind"]]


def by_kind(claim: Claim, function: str, *arguments: Any, default: Any) -> Any:
    """Call a function of a claim's kind, if defined."""
    kind = kind_of(claim)
    return getattr(kind, function)(claim, *arguments) if hasattr(kind, function) else default


def compared(claim: Claim) -> list[Sequence[Row]]:
    """The rows of methods on scenes' viewpoints, by comparison."""
    return by_kind(claim, "compared", default=[])


def methods(claim: Claim) -> list[Row]:
    """All rows of methods on scenes' viewpoints."""
    return [row for rows in compared(claim) for row in rows]

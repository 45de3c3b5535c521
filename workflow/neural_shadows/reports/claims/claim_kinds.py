"""The interface of a claim's kind, a module of `kinds/`.

Each has
    Settings: the model of its section.
    files(layout, claim): paths by argument of `write_claims.claims`.
    comparisons(claim, data): a list of `Comparison`.
Where it applies, it has
    compared(claim): the rows of methods on scenes' viewpoints, by comparison.
    without_networks(claim, data): by null predictor the comparisons with it in the networks' place.
    network_wins(claim): whether a network is a claimed winner; in kinds without it one is.
    not_comparable(claim, data): why the measurements are of something else; empty if not.
    not_learned(claim, row, budget, data): why a row has not learned; empty if it has.
    by_all_pixels(claim): the claim on errors of all pixels; None of one without errors off edges.
    counts_by_view(metrics): values beside image metrics, a row a view.
    NEEDS_SEEDS: it compares trainings, of which one alone decides nothing.
    COUNTS_VIOLATIONS: it counts how often depths break their bounds.
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
    """Call a function of a claim's kind, if there."""
    kind = kind_of(claim)
    return getattr(kind, function)(claim, *arguments) if hasattr(kind, function) else default


def compared(claim: Claim) -> list[Sequence[Row]]:
    """The rows of methods on scenes' viewpoints, by comparison."""
    return by_kind(claim, "compared", default=[])


def methods(claim: Claim) -> list[Row]:
    """All rows of methods on scenes' viewpoints."""
    return [row for rows in compared(claim) for row in rows]

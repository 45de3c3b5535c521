"""The interface of a claim's kind, a module of `kinds/`.

Each has
    Settings: the model of its section; its `resolved` claims on scenes' viewpoints have `rows` of
        methods by comparison, those on screen-space networks `networks`.
    files(layout, claim): paths by argument of `write_claims.claims`.
    comparisons(claim, data): a list of `Comparison`.
or `source(claim)`, the module with all but `Settings`.
Where it applies, it has
    without_networks(claim, data): comparisons with null predictors for networks, by null predictor.
    network_wins(claim): a network is a claimed winner; True in kinds without this function.
    not_learned(claim, data): evidence that a network has not learned, or "".
    by_all_pixels(claim): the claim on errors of all pixels, or None without errors off edges.
    counts_by_view(metrics): values beside image metrics, a row a view.
    soft_table(claim): its table of methods for soft shadows, or None.
    LEAST_SEEDS: of its trainings, instead of two.
    WITHOUT_RUN: it judges a text by itself.
"""

from types import ModuleType
from typing import Any

from neural_shadows.reports.claims.measured import Claim
from neural_shadows.reports.data.trained import Row
from neural_shadows.settings.kinds import kinds


def kind_of(claim: Claim) -> ModuleType:
    """The module with the functions of a claim's kind."""
    kind = kinds("reports/claims/kinds")[claim["kind"]]
    return kind.source(claim) if hasattr(kind, "source") else kind


def by_kind(claim: Claim, name: str, *arguments: Any, default: Any) -> Any:
    """A constant of a claim's kind, or a function's result, if defined."""
    value = getattr(kind_of(claim), name, default)
    return value(claim, *arguments) if callable(value) else value


def methods(claim: Claim) -> list[Row]:
    """All rows of methods on scenes' viewpoints."""
    return [row for rows in claim.get("rows", ()) for row in rows]

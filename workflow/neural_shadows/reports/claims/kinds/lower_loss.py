"""Pairs (lower, higher) of networks by their end losses."""

from collections.abc import Sequence
from typing import Literal

import numpy as np
from pydantic import Field

from neural_shadows.evaluation.null_predictors import NO_SHADOW
from neural_shadows.layout import tables
from neural_shadows.layout.layout import Layout
from neural_shadows.metrics.intervals import t_interval
from neural_shadows.reports.claims import row_claims, setting_types
from neural_shadows.reports.claims.claim_kinds import methods
from neural_shadows.reports.claims.comparison import Comparison, judged, unjudged
from neural_shadows.reports.claims.learning import follow
from neural_shadows.reports.claims.measured import Claim, Measured, labels
from neural_shadows.reports.data.digits import short
from neural_shadows.reports.data.trained import Budget, Row
from neural_shadows.sections.sections import Sections
from neural_shadows.settings.base import name_in

NEEDS_SEEDS = True
LOSS_MARGIN = 0.02  # of no shadow's loss: random variation at the end of a curve


class Settings(row_claims.RowsClaim):
    """Networks compared by the end of their training loss."""

    kind: Literal["lower_loss"] = Field(description="`lower_loss`")
    pairs: setting_types.pairs(name_in("experiments")) = Field(
        description="experiments, the claimed winner first"
    )

    def check_method(self, config: Sections, key: str, method: str) -> None:
        super().check_method(config, key, method)
        if config.experiments[method].training is None:
            raise ValueError(f"{key}: {method!r} is not trained and has no loss. Remove it")
        if not (network := config.network_of(method)).loss_of_depths:
            # Losses with cross-entropy are not comparable to those of depths.
            raise ValueError(
                f"{key}: {method!r} of encoding {network.encoding!r} has another loss than the thesis's "
                "networks. Compare it by image metrics (kind: better)"
            )


compared = row_claims.compared_in_pairs


def files(layout: Layout, claim: Claim) -> dict[str, list[str]]:
    rows = tables.with_curves(layout, methods(claim))
    losses = tables.networks(layout, rows, "loss.csv")
    return row_claims.row_files(layout, rows) | {"losses": losses}


def comparisons(claim: Claim, data: Measured) -> list[Comparison]:
    """A comparison for each pair.

    It has one value a seed: a curve's points are no replicates.
    """
    return [_comparison(pair, data) for pair in claim["pairs"]]


def without_networks(claim: Claim, data: Measured) -> dict[str, list[Comparison]]:
    """The comparisons with no shadow's loss for the claimed winner's."""
    return {NO_SHADOW: [_without_first(pair, data) for pair in claim["pairs"]]}


def not_learned(claim: Claim, row: Row, budget: Budget, data: Measured) -> str:
    """The failure of the first training without content, if any.

    Its loss ends no lower than no shadow's, or it diverged. A diverged claimed loser is the subject
    of such a claim, for instance with too high a rate.
    """
    first, second = ({pair[side]["method"] for pair in claim["pairs"]} for side in (0, 1))
    loser = row["method"] in second - first
    for run, loss in zip(budget.runs[row["experiment"]], data.end_losses(row, budget)):
        record = data.trainings[run]
        died, null = record["died_at_step"], record["no_shadow_loss"]
        if died is not None:
            if not loser:
                return f"died at step {died:,}"
        elif loss >= (1 - LOSS_MARGIN) * null:
            margin = f"(margin {100 * LOSS_MARGIN:.0f} %)"
            return f"loss {short(loss)}, without shadow {short(null)} {margin}"
    return ""


def _without_first(pair: Sequence[Row], data: Measured) -> Comparison:
    fields = {"metric": "loss", "methods": " against ".join(labels(pair)), "text": NO_SHADOW}
    if reason := data.unshared(pair):
        return Comparison(**fields, **unjudged(incomparable=reason))
    budget = data.budgets(pair)[-1]
    runs = budget.runs[pair[0]["experiment"]]
    null = np.array([data.trainings[run]["no_shadow_loss"] for run in runs])
    return Comparison(**fields, **judged(*t_interval(data.end_losses(pair[1], budget) - null)))


def _comparison(pair: Sequence[Row], data: Measured) -> Comparison:
    methods = " against ".join(labels(pair))
    if reason := data.unshared(pair):
        return Comparison("loss", methods, f"loss of {methods}", **unjudged(incomparable=reason))
    budgets = data.budgets(pair)
    losses = [[data.end_losses(row, budget) for budget in budgets] for row in pair]
    (a, b), (first, second) = (arm[-1] for arm in losses), labels(pair)
    return Comparison(
        metric="loss",
        methods=methods,
        text=f"loss of {first} {short(a.mean())} against {second} {short(b.mean())}",
        **judged(*t_interval(b - a)),
        seeds=budgets[-1].seeds,
        samples=budgets[-1].samples,
        learning=follow(pair, budgets, losses, data),
    )

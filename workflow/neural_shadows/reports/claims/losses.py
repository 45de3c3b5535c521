"""Networks on rays, compared by the end of their training loss."""

from collections.abc import Sequence

import numpy as np

from neural_shadows.evaluation.null_predictors import NO_SHADOW
from neural_shadows.layout import tables
from neural_shadows.layout.layout import Layout
from neural_shadows.metrics.intervals import t_interval
from neural_shadows.reports.claims import views
from neural_shadows.reports.claims.claim_kinds import methods
from neural_shadows.reports.claims.comparison import Comparison, judged
from neural_shadows.reports.claims.learning import follow
from neural_shadows.reports.claims.measured import Claim, Measured, labels
from neural_shadows.reports.data.digits import short
from neural_shadows.reports.data.trained import Budget, Row
from neural_shadows.sections.sections import Sections

METRICS = ("loss",)
LOSS_MARGIN = 0.02  # of no shadow's loss: random variation at the end of a curve

network_wins = views.network_wins


def check_methods(config: Sections, key: str, compared: Sequence[Sequence[str]]) -> None:
    """Check that methods are networks with losses of depths."""
    views.check_methods(config, key, compared)
    for name in (name for names in compared for name in names):
        if name not in config.ray_experiments or config.ray_experiments[name].training is None:
            raise ValueError(f"{key}: {name!r} is not trained and has no loss. Remove it")
        if not (network := config.network_of(name)).loss_of_depths:
            # Losses with cross-entropy are not comparable to those of depths.
            raise ValueError(
                f"{key}: {name!r} of encoding {network.encoding!r} has another loss than the thesis's "
                "networks. Compare it by image metrics"
            )


def files(layout: Layout, claim: Claim) -> dict[str, list[str]]:
    """Files of a claim on losses."""
    rows = tables.with_curves(layout, methods(claim))
    losses = tables.networks(layout, rows, "loss.csv")
    return views.row_files(layout, rows) | {"losses": losses}


def comparisons(claim: Claim, data: Measured) -> list[Comparison]:
    """A comparison for each pair.

    It has one value a seed: a curve's points are no replicates.
    """
    return [_comparison(pair, data) for pair in claim["rows"]]


def without_networks(claim: Claim, data: Measured) -> dict[str, list[Comparison]]:
    """The comparisons with no shadow's losses for the networks'."""
    return {NO_SHADOW: [_of_no_shadow(pair, data) for pair in claim["rows"]]}


def not_learned(claim: Claim, data: Measured) -> str:
    """Name the networks that end no lower than no shadow."""
    return views.failures(claim, data, _failure)


def _failure(claim: Claim, data: Measured, row: Row, budget: Budget) -> str:
    """The failure of the first training without content, if any.

    Its loss ends no lower than no shadow's, or it diverged. A diverged claimed loser is the subject
    of such a claim, for instance with too high a rate.
    """
    first, second = ({pair[side]["method"] for pair in claim["rows"]} for side in (0, 1))
    loser = row["method"] in second - first
    for run, loss in zip(budget.runs[row["experiment"]], data.end_losses(row, budget)):
        record = data.trainings[run]
        step, null = record["died_at_step"], record["no_shadow_loss"]
        if step is not None:
            if not loser:
                return f"diverged at step {step:,}"
        elif loss >= (1 - LOSS_MARGIN) * null:
            margin = f"(margin {100 * LOSS_MARGIN:.0f} %)"
            return f"loss {short(loss)}, without shadow {short(null)} {margin}"
    return ""


def _of_no_shadow(pair: Sequence[Row], data: Measured) -> Comparison:
    """Compare the losses of no shadow on a pair's rays, at the largest budget."""
    fields = {"metric": "loss", "methods": NO_SHADOW, "text": NO_SHADOW}
    if reason := data.unshared(pair):
        return Comparison(**fields, incomparable=reason)
    runs = data.budgets(pair)[-1].runs
    first, second = (
        np.array([data.trainings[run]["no_shadow_loss"] for run in runs[row["experiment"]]])
        for row in pair
    )
    return Comparison(**fields, **judged(*t_interval(second - first)))


def _comparison(pair: Sequence[Row], data: Measured) -> Comparison:
    """Compare a pair by seeds."""
    fields = {"metric": "loss", "methods": " against ".join(labels(pair))}
    if reason := data.unshared(pair):
        text = f"loss of {fields['methods']}"
        return Comparison(**fields, text=text, incomparable=reason)
    budgets = data.budgets(pair)
    losses = [[data.end_losses(row, budget) for budget in budgets] for row in pair]
    (a, b), (first, second) = (arm[-1] for arm in losses), labels(pair)
    return Comparison(
        **fields,
        text=f"loss of {first} {short(a.mean())} against {second} {short(b.mean())}",
        **judged(*t_interval(b - a)),
        seeds=budgets[-1].seeds,
        samples=budgets[-1].samples,
        learning=follow(pair, budgets, losses, data),
    )

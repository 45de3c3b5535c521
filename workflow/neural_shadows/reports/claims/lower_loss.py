"""Pairs (lower, higher) of networks by the end of their training loss."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from neural_shadows.metrics.intervals import t_interval
from neural_shadows.metrics.power_law import FEWEST_BUDGETS, Curve
from neural_shadows.reports.claims.comparison import Comparison, judged, unjudged
from neural_shadows.reports.claims.learning import followed
from neural_shadows.reports.claims.measured import Measured, Row, labels
from neural_shadows.reports.digits import short


def comparisons(claim: Mapping[str, Any], data: Measured) -> list[Comparison]:
    """A comparison for each pair: one value a seed, since a curve's points are no replicates."""
    return [_compared(pair, data) for pair in claim["pairs"]]


def _compared(pair: Sequence[Row], data: Measured) -> Comparison:
    methods = " against ".join(labels(pair))
    if why := data.unshared(pair):
        return Comparison("loss", methods, f"loss of {methods}", **unjudged(incomparable=why))
    budgets = data.budgets(pair)
    samples = np.array([budget.samples for budget in budgets])
    arms = [np.array([data.end_losses(row, one) for one in budgets]) for row in pair]
    (a, b), (first, second) = (arm[-1] for arm in arms), labels(pair)
    curves = [Curve(samples, values) for values in arms]
    learning = None
    if len(budgets) >= FEWEST_BUDGETS:
        died = any(data.died(row, budgets) for row in pair)
        learning = followed(
            *curves, learn=(True, True), died=died, psnr=False, views=(0.0, 0.0), seed=data.seed
        )
    return Comparison(
        metric="loss",
        methods=methods,
        text=f"loss of {first} {short(a.mean())} against {second} {short(b.mean())}",
        **judged(*t_interval(b - a)),
        seeds=budgets[-1].seeds,
        samples=budgets[-1].samples,
        learning=learning,
    )

"""Costs of violated bounds: false shadow or light leaks [5.1]."""

from collections.abc import Sequence
from typing import Any, Literal

import numpy as np
import pandas as pd
from pydantic import Field

from neural_shadows.evaluation.violations import RANDOM
from neural_shadows.layout import tables
from neural_shadows.layout.layout import Layout
from neural_shadows.layout.parts import batches
from neural_shadows.metrics.intervals import FEWEST_VIEWS, two_way_interval
from neural_shadows.reports.claims import views
from neural_shadows.reports.claims.claim_kinds import methods
from neural_shadows.reports.claims.comparison import Comparison, judged
from neural_shadows.reports.claims.measured import Claim, Measured, labels
from neural_shadows.reports.data.trained import Row
from neural_shadows.sections.any_report import AnyClaim
from neural_shadows.sections.sections import Sections

LEAST_SEEDS = 1
# Counts of violations, of those at points where the error can occur, and of those where it does.
LOWER = ("lower_violations", "lit_of_lower", "false_shadow_of_lower")
UPPER = ("upper_violations", "shadowed_of_upper", "light_leak_of_upper")
COUNTS = (*LOWER, *UPPER)


class Settings(AnyClaim):
    """Violations of the lower bound against those of the upper.

    For each network the former must show more often.
    """

    kind: Literal["violations"] = Field(description="`violations`")
    methods: list[str] = Field(min_length=1, description="networks")

    def check(self, config: Sections, key: str) -> None:
        views.check_methods(config, f"{key}.methods", [[method] for method in self.methods])

    def resolved(self, config: Sections) -> dict[str, Any]:
        rows = [[row] for row in views.compared_rows(config, self.methods)]
        return self.model_dump() | {"rows": rows}


not_learned = views.not_learned


def files(layout: Layout, claim: Claim) -> dict[str, list[str]]:
    """Files of a claim on images, with the counts of the networks' longest trainings."""
    of_views, rows = views.files(layout, claim), methods(claim)
    shorter = {
        point["experiment"]
        for points in tables.curves(layout, rows).values()
        for point in points
        if point["samples"] < points[-1]["samples"]
    }
    counted = [
        layout.paths.violations(row["scene"], row["method"], batch)
        for row in tables.with_curves(layout, rows)
        if row["experiment"] not in shorter
        for batch in batches(layout.views)
    ]
    return of_views | {"metrics": [*of_views["metrics"], *counted]}


def comparisons(claim: Claim, data: Measured) -> list[Comparison]:
    """A comparison for each network, of its largest budget.

    Compares P(false shadow | t < t_lb, point lit) − P(light leak | t > t_ub, point in
    shadow): the cost of a violation, independent of how often each bound is violated and of
    the lit share of the frame. Counts of all views are added.
    """
    rows = methods(claim)
    return [_comparison(label, row, data, COUNTS) for label, row in zip(labels(rows), rows)]


def without_networks(claim: Claim, data: Measured) -> dict[str, list[Comparison]]:
    """The comparisons with depths drawn at random, on the same rays."""
    names = [f"{RANDOM}{name}" for name in COUNTS]
    return {
        "random_depths": [_comparison("random depths", row, data, names) for row in methods(claim)]
    }


def _comparison(label: str, row: Row, data: Measured, names: Sequence[str]) -> Comparison:
    budget = data.budgets([row])[-1]
    fields = {
        "metric": "seen violations",
        "methods": label,
        "text": label,
        "seeds": budget.seeds if budget.runs else None,
        "samples": budget.samples,
    }
    frames = [data.metrics[row["scene"]][method][[*names]] for method in data.methods(row, budget)]
    counts = np.stack([frame.to_numpy() for frame in frames])  # (S, V, 6)
    lower, lit, false, upper, shadowed, leak = counts.sum((0, 1))
    if not lit or not shadowed:
        missing = "lower bound is violated at no lit" if not lit else "upper bound at no shadowed"
        return Comparison(**fields, untested=f"the {missing} point")
    fields["text"] = (
        f"{label}: false shadow at {100 * false / lit:.3g} % of the {lit:,.0f} points that are "
        f"lit, of {lower:,.0f} with a violated lower bound, and light leak at "
        f"{100 * leak / shadowed:.3g} % of the {shadowed:,.0f} in shadow, of {upper:,.0f} with a "
        "violated upper one"
    )
    if len(frames[0]) < FEWEST_VIEWS:
        few = f"{len(frames[0])} views are too few: it takes {FEWEST_VIEWS}"
        return Comparison(**fields, untested=few)
    groups = frames[0].index.get_level_values("view_set")
    return Comparison(**fields, **judged(*two_way_interval(counts, _excess, groups)))


def _excess(counts: np.ndarray) -> float:
    _, lit, false, _, shadowed, leak = counts.sum((0, 1))
    # With a view left out a bound may be without violations, which then cost nothing.
    return float(false / max(lit, 1) - leak / max(shadowed, 1))


def counts_by_view(metrics: pd.DataFrame) -> pd.DataFrame:
    """Counts by view; a column a (method, count)."""
    counts = metrics[metrics["metric"].isin([*COUNTS, *(f"{RANDOM}{name}" for name in COUNTS)])]
    return counts.pivot(index=["view_set", "view"], columns=["method", "metric"], values="value")

"""Networks by what a violated bound costs: shadow that is false, or light that leaks [5.1]."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from neural_shadows.metrics.intervals import two_way_interval
from neural_shadows.reports.claims.comparison import Comparison, judged
from neural_shadows.reports.claims.measured import Measured, Row, labels

# The number of violations, and that of those that are seen.
LOWER = ("lower_violations", "false_shadow_of_lower")
UPPER = ("upper_violations", "light_leak_of_upper")


def comparisons(claim: Mapping[str, Any], data: Measured) -> list[Comparison]:
    """A comparison for each network, of its largest budget.

    What is compared is P(false shadow | t < t_lb) − P(light leak | t > t_ub): the thesis speaks of
    what a violation costs, however often each bound is violated. Counts of all views are added.
    """
    rows = claim["methods"]
    return [_compared(label, row, data) for label, row in zip(labels(rows), rows)]


def _compared(label: str, row: Row, data: Measured) -> Comparison:
    budget = data.budgets([row])[-1]
    kept = {
        "metric": "seen violations",
        "seeds": budget.seeds if budget.runs else None,
        "samples": budget.samples,
    }
    frames = [
        data.metrics[row["scene"]][method][[*LOWER, *UPPER]] for method in data.methods(row, budget)
    ]
    counts = np.stack([frame.to_numpy() for frame in frames])  # (S, V, 4)
    violations = counts.sum((0, 1))
    if not violations[0] or not violations[2]:
        which = "lower" if not violations[0] else "upper"
        numbers = f"the {which} bound is never violated"
        return Comparison(**kept, text=label, numbers=numbers, supports=False, against=1.0)
    groups = frames[0].index.get_level_values("view_set")
    found = two_way_interval(counts, data.seed, _excess, np.array(groups))
    false, leak = violations[1] / violations[0], violations[3] / violations[2]
    text = (
        f"{label}: false shadow at {100 * false:.3g} % of {violations[0]:,.0f} violations "
        f"of the lower bound, light leak at {100 * leak:.3g} % of {violations[2]:,.0f} of the upper"
    )
    return Comparison(**kept, text=text, **judged(*found))


def _excess(counts: np.ndarray) -> float:
    lower, false, upper, leak = counts.sum((0, 1))
    # A resampling may have no violation of a bound: it then cost nothing.
    return float(false / max(lower, 1) - leak / max(upper, 1))


def counts_by_view(metrics: pd.DataFrame) -> pd.DataFrame:
    """Counts with a row a view and a column a (method, count), of the methods that have them."""
    found = metrics[metrics["metric"].isin([*LOWER, *UPPER])]
    return found.pivot(index=["view_set", "view"], columns=["method", "metric"], values="value")

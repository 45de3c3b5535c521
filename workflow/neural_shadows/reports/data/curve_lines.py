"""Lines of a learning curve: each budget's errors, a hold-out and an extrapolation; and their cells."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pandas as pd

from neural_shadows.metrics import power_law
from neural_shadows.metrics.power_law import Curve
from neural_shadows.metrics.registry import metrics, value_of
from neural_shadows.reports.data.table import number_cells, with_ends

PREDICTED = with_ends("predicted")
COLUMNS = [
    *("scene", "method", "metric", "kind", "samples", "mean", "spread", "by_seed", "exponent"),
    *(*PREDICTED, "step", "error", "unlicensed", "no_shadow", "thesis"),
]
# Columns in a metric's unit; the last three of networks on frames alone.
ERRORS = ["mean", "spread", *PREDICTED, "no_shadow", "base", "train_mean", "train_base"]
MEASURED, EXTRAPOLATED = "measured", "extrapolated"  # kinds of rows


def metric_lines(
    metric: str, curve: Curve, further: int, seed: int, diverged: bool
) -> list[dict[str, Any]]:
    """Tabulate a curve of errors by budget, and its extrapolation.

    Args:
        further: samples of the extrapolation. diverged: one of its trainings did.
    """
    lines = []
    for count, errors in zip(curve.samples, curve.values):
        each = value_of(metric, errors)
        lines.append(
            {
                "kind": MEASURED,
                "samples": count,
                "mean": value_of(metric, errors.mean()),
                "spread": each.std(ddof=1) if len(each) > 1 else np.nan,
                "by_seed": " ".join(f"{value:.6g}" for value in each),
            }
        )
    for line, exponent in zip(lines[1:], power_law.local_exponents(curve)):
        line["exponent"] = exponent
    if power_law.can_hold_out(curve) and (held_out := power_law.hold_out(curve, seed)):
        lines[-1] |= _prediction(metric, held_out.predicted, held_out.low, held_out.high)
        lines[-1] |= {"step": held_out.step, "error": held_out.error}
    allowed, reason = power_law.licensed([curve], further, seed, diverged)
    step = further / curve.samples[-1]
    lines.append(
        {"kind": EXTRAPOLATED, "samples": further, "step": step, "unlicensed": reason},
    )
    if allowed:
        lines[-1] |= _prediction(metric, *power_law.extrapolate(curve, further, seed))
    return lines


def _prediction(metric: str, *errors: float) -> dict[str, float]:
    """A predicted error and the ends of its interval as values, the lower end first."""
    value, *ends = (value_of(metric, error) for error in errors)
    return dict(zip(PREDICTED, (value, *sorted(ends))))


def by_kind(part: pd.DataFrame) -> tuple[pd.DataFrame, pd.Series]:
    """Split a method's rows of a metric into measured and extrapolated."""
    measured = part["kind"] == MEASURED
    return part[measured], part[~measured].iloc[0]


def curve_cells(
    table: pd.DataFrame,
    budget: Callable[[float], str],
    beyond: str,
    beside: Callable[[pd.Series, pd.Series, str], Mapping[str, str]],
) -> dict[str, list[str]]:
    """Format the cells by heading: a row for each method and metric.

    Args:
        table: rows of `metric_lines`, by scene and method.
        budget: the heading of a budget. beyond: that of the extrapolation.
        beside: of a method's largest budget, its extrapolation and the metric's format, more cells.
    """
    budgets = sorted(table.loc[table["kind"] == MEASURED, "samples"].unique())
    lines = []
    for (scene, method, metric), part in table.groupby(["scene", "method", "metric"], sort=False):
        described = metrics()[metric]
        form = f"{{:.{described.digits}f}}"
        measured, extrapolated = by_kind(_scaled(part, described.factor))
        last = measured.iloc[-1]
        exponents = measured["exponent"].dropna()
        ends = exponents.iloc[[0, -1]] if len(exponents) else exponents
        reached = measured.set_index("samples").reindex(budgets)
        spreads = number_cells(reached["spread"], f" ± {form}")
        means = number_cells(reached["mean"], form)
        error = "" if np.isnan(last["error"]) else f"{100 * last['error']:+.1f} %"
        lines.append(
            {"scene": scene, "method": method, "metric": described.heading}
            | {budget(samples): a + b for samples, a, b in zip(budgets, means, spreads)}
            | {
                "exponent": " → ".join(f"{exponent:.2f}" for exponent in ends),
                "largest, as predicted": _interval(last, form),
                "missed by": error,
                beyond: extrapolated["unlicensed"] or _interval(extrapolated, form),
            }
            | beside(last, extrapolated, form)
            | {"no shadow": form.format(last["no_shadow"])}
        )
    return {name: [line[name] for line in lines] for name in lines[0]}


def _scaled(part: pd.DataFrame, factor: float) -> pd.DataFrame:
    """Rows with values in a metric's unit."""
    if factor == 1:
        return part
    errors = part.columns.intersection(ERRORS)
    return part.assign(**{name: factor * part[name].astype(float) for name in errors})


def _interval(line: pd.Series, form: str) -> str:
    value, low, high = line[PREDICTED].astype(float)
    if np.isnan(value):
        return ""
    ends = "" if np.isnan(low) else f" [{form}, {form}]".format(low, high)
    return form.format(value) + ends

"""Lines of a learning curve: each budget's errors, a hold-out and an extrapolation."""

from typing import Any

import numpy as np
import pandas as pd

from neural_shadows.metrics import power_law
from neural_shadows.metrics.power_law import Curve
from neural_shadows.metrics.registry import value_of
from neural_shadows.reports.data.table import with_ends

PREDICTED = with_ends("predicted")
COLUMNS = [
    *("scene", "method", "metric", "kind", "samples", "mean", "spread", "by_seed", "exponent"),
    *(*PREDICTED, "step", "error", "unlicensed", "no_shadow", "thesis"),
]
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

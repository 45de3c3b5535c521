"""How far a soft visibility is from its target, by what blocks the light."""

from collections.abc import Mapping

import numpy as np

from neural_shadows.metrics.visibility_error import LIT, UMBRA

WIDEST = 90  # percentile of a frame's penumbra pixels by their penumbra's width
MOST = 3  # solids: as many and more are one


def errors_by_occluders(
    found: np.ndarray,
    target: np.ndarray,
    valid: np.ndarray,
    solids: np.ndarray,
    widths: np.ndarray,
) -> Mapping[str, float]:
    """Squared errors over parts of a frame's valid pixels; NaN where there are none.

    `mse_widest`: of the tenth of the pixels in a penumbra whose penumbra is widest. `mse_solids_1`, …:
    of those with so many solids before the light, `mse_behind` of all that have some, and
    `solids_behind` how many these have on average. `mse_per_solid`: by how much the error grows with
    each solid, by least squares; NaN where all have as many.

    Args:
        found, target: (H, W) float32 in [0, 1]; valid: bool. solids: see `solids_before`.
        widths: in pixels, 0 where all of the light is seen.
    """
    square = np.subtract(found, target, dtype=np.float64) ** 2
    penumbra = valid & (target >= UMBRA) & (target <= LIT) & (widths > 0)
    wide = np.percentile(widths[penumbra], WIDEST) if penumbra.any() else np.inf
    behind = valid & (solids > 0)
    counts, of_behind = np.minimum(solids[behind], MOST), square[behind]
    errors = {"mse_widest": _mean(square[penumbra & (widths >= wide)])}
    errors |= {
        f"mse_solids_{number}": _mean(of_behind[counts == number]) for number in range(1, MOST + 1)
    }
    errors |= {"mse_behind": _mean(of_behind), "solids_behind": _mean(counts)}
    return errors | {"mse_per_solid": _slope(counts, of_behind)}


def _mean(values: np.ndarray) -> float:
    return float(values.mean()) if values.size else float("nan")


def _slope(x: np.ndarray, y: np.ndarray) -> float:
    if x.size == 0 or np.ptp(x) == 0:
        return float("nan")
    off = x - x.mean()
    return float(off @ y / (off @ off))

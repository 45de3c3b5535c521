"""Errors of soft visibility, by occluders."""

import numpy as np

from neural_shadows.metrics.kinds.errors_of_visibility import LIT, UMBRA
from neural_shadows.metrics.metric import Metric

WIDEST = 90  # percentile of a frame's penumbra pixels by their penumbra's width
MOST = 3  # solids: more are counted as these

_SQUARED = {"unit": "× 10⁻⁴", "factor": 1e4, "digits": 1, "lights": ("soft",)}
METRICS = {
    "mse_widest": Metric("MSE", "of the widest penumbrae", **_SQUARED),
    **{
        f"mse_solids_{n}": Metric("MSE", f"behind {n} solid{'s' * (n > 1)}", **_SQUARED)
        for n in range(1, MOST + 1)
    },
    "mse_behind": Metric("MSE", "behind solids", **_SQUARED),
    "solids_behind": Metric("solids", better=None, lights=("soft",)),
    "mse_per_solid": Metric("MSE", "of each solid", **_SQUARED),
}


def of_occluders(
    visibility: np.ndarray,
    target: np.ndarray,
    valid: np.ndarray,
    solids: np.ndarray,
    widths: np.ndarray,
) -> dict[str, float]:
    """Squared errors over parts of a frame's valid pixels. NaN where a part has no pixel.

    `mse_widest`: of the tenth of the pixels in a penumbra whose penumbra is widest. `mse_solids_1`, …:
    of those with this number of solids before the light, `mse_behind` of those with any, and
    `solids_behind` their mean number. `mse_per_solid`: by how much the error grows with
    each solid, more than `MOST` as `MOST`, by least squares; NaN where all have the same number.

    Args:
        visibility, target: (H, W) float32 in [0, 1]; valid: bool. solids: see `solids_before`.
        widths: in pixels, 0 where all of the light is seen.
    """
    square = np.subtract(visibility, target, dtype=np.float64) ** 2
    penumbra = valid & (target >= UMBRA) & (target <= LIT) & (widths > 0)
    threshold = np.percentile(widths[penumbra], WIDEST) if penumbra.any() else np.inf
    behind = valid & (solids > 0)
    counts, of_behind = np.minimum(solids[behind], MOST).astype(np.float64), square[behind]
    errors = {"mse_widest": _mean(square[penumbra & (widths >= threshold)])}
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
    centred = x - x.mean()
    return float(centred @ y / (centred @ centred))

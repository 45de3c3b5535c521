"""Errors of soft visibility, by part of the shadow."""

from collections.abc import Mapping

import numpy as np
import scipy

UMBRA, LIT = 0.02, 0.98  # of the target: below and above it there is no penumbra
EDGE_PIXELS = 3  # on each side of an edge of the hard target


def visibility_errors(
    visibility: np.ndarray,
    target: np.ndarray,
    valid: np.ndarray,
    hard: np.ndarray | None,
    off_edges: np.ndarray | None = None,
) -> Mapping[str, float]:
    """Errors over a frame's valid pixels. Mean square, mean absolute, and parts of the former.

    `mse_umbra`, `mse_penumbra` and `mse_lit` are of those pixels by their target, and `mse_edge` of
    those near an edge of the hard shadow; NaN where there are none. `false_shadow` and `light_leak`
    are means of what is too dark and too bright. `mse_off_edges` is of valid pixels off the geometry's
    edges, where no antialiasing of these adds to it.

    Args:
        visibility, target, hard: (H, W) float32 in [0, 1], the last of the light's centre, None if it is
            not known; valid: bool. off_edges: those of `valid` off edges; None if not known.

    Raises:
        ValueError: no pixel is valid.
    """
    if not valid.any():
        raise ValueError("visibility_errors: no pixel shows a surface")
    difference = np.subtract(visibility, target, dtype=np.float64)
    square = difference**2
    parts = {
        "": valid,
        "_umbra": valid & (target < UMBRA),
        "_penumbra": valid & (target >= UMBRA) & (target <= LIT),
        "_lit": valid & (target > LIT),
        "_edge": valid & (False if hard is None else _near_edges(hard, valid)),
        **({} if off_edges is None else {"_off_edges": off_edges}),
    }
    errors = {
        f"mse{name}": float(square[part].mean()) if part.any() else float("nan")
        for name, part in parts.items()
    }
    valid_difference = difference[valid]
    return errors | {
        "l1": float(np.abs(valid_difference).mean()),
        "false_shadow": float((-valid_difference).clip(0).mean()),
        "light_leak": float(valid_difference.clip(0).mean()),
    }


def _near_edges(hard: np.ndarray, valid: np.ndarray) -> np.ndarray:
    """Pixels near an edge of the hard shadow.

    Between two valid neighbours of which one is lit and the other is not.
    """
    lit = hard > 0.5
    edge = np.zeros_like(lit)
    across = (lit[1:] != lit[:-1]) & valid[1:] & valid[:-1]
    edge[1:] |= across
    edge[:-1] |= across
    along = (lit[:, 1:] != lit[:, :-1]) & valid[:, 1:] & valid[:, :-1]
    edge[:, 1:] |= along
    edge[:, :-1] |= along
    square = np.ones((2 * EDGE_PIXELS - 1,) * 2, bool)
    return scipy.ndimage.binary_dilation(edge, square)

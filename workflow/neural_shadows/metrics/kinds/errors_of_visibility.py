"""Errors of visibility: shares by direction, and squared ones by part of the shadow."""

from typing import NamedTuple

import numpy as np

from neural_shadows.metrics.metric import Metric, Pixels

UMBRA, LIT = 0.02, 0.98  # of the target: below and above it there is no penumbra

_SQUARED = {"unit": "× 10⁻⁴", "factor": 1e4, "digits": 1, "lights": ("soft",)}
_SHARE = {"unit": "%", "factor": 100, "digits": 2}
METRICS = {
    "mse": Metric("MSE", **_SQUARED),
    "mse_umbra": Metric("MSE", "umbra", **_SQUARED),
    "mse_penumbra": Metric("MSE", "penumbra", **_SQUARED),
    "mse_lit": Metric("MSE", "lit", **_SQUARED),
    "mse_edge": Metric("MSE", "edge", **_SQUARED),
    "mse_off_edges": Metric("MSE", "off edges", **_SQUARED),
    "l1": Metric("L1", **_SHARE, lights=("soft",)),
    "shadow_error": Metric("shadow error", **_SHARE, lights=("hard",)),
    "false_shadow": Metric("false shadow", **_SHARE),
    "light_leak": Metric("light leak", **_SHARE),
}


class ShadowError(NamedTuple):
    """Means over the surface points. Of hard shadows, shares of wrong points."""

    shadow_error: float  # sum of the others
    false_shadow: float  # darker than the reference
    light_leak: float  # brighter than the reference


def of_visibility(visibility: np.ndarray, target: np.ndarray, pixels: Pixels) -> dict[str, float]:
    """Errors over a frame's valid pixels: squared by part, and shares; `l1` is the shares' sum.

    Raises:
        ValueError: no pixel is valid.
    """
    shares = shadow_error(visibility[pixels.valid], target[pixels.valid])
    squared = squared_errors(visibility, target, pixels)
    return squared | {"l1": shares.shadow_error} | shares._asdict()


def shadow_error(visibility: np.ndarray, reference: np.ndarray) -> ShadowError:
    """Mean differences of visibilities in [0, 1]. Of a frame's n surface points, each (n,).

    Raises:
        ValueError: there are no points.
    """
    if len(reference) == 0:
        raise ValueError("shadow_error: no pixel shows a surface")
    difference = np.subtract(visibility, reference, dtype=np.float64)
    sums = np.abs(difference).sum(), (-difference).clip(0).sum(), difference.clip(0).sum()
    return ShadowError(*(float(total / len(reference)) for total in sums))


def squared_errors(visibility: np.ndarray, target: np.ndarray, pixels: Pixels) -> dict[str, float]:
    """Mean squared errors over a frame's valid pixels.

    `mse_umbra`, `mse_penumbra` and `mse_lit` are of those pixels by their target, and `mse_edge` of
    those near an edge of the hard shadow; NaN where there are none. `mse_off_edges`, where known, is
    of valid pixels off the geometry's edges, where no antialiasing of these adds to it.

    Args:
        visibility, target: float32 in [0, 1], of the shape of `pixels`.
    """
    square = np.subtract(visibility, target, dtype=np.float64) ** 2
    valid, off_edges = pixels.valid, pixels.off_edges
    parts = {
        "mse": valid,
        "mse_umbra": valid & (target < UMBRA),
        "mse_penumbra": valid & (target >= UMBRA) & (target <= LIT),
        "mse_lit": valid & (target > LIT),
        "mse_edge": valid & pixels.near_edges,
        **({} if off_edges is None else {"mse_off_edges": off_edges}),
    }
    return {
        name: float(square[part].mean()) if part.any() else float("nan")
        for name, part in parts.items()
    }

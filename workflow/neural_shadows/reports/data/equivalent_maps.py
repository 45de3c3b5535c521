"""The size of the equally good shadow map.

It depends less on mesh, views and LPIPS network than the quality itself: the thesis's network on
the dragon equals its shadow map of 386² by LPIPS, of 191² by PSNR.
"""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from neural_shadows.evaluation.registry import family_and_size
from neural_shadows.metrics.equivalent_resolution import equivalent_resolution
from neural_shadows.metrics.pooled_psnr import mse_of


def equivalent_maps(
    table: pd.DataFrame, methods: Sequence[str], psnr: str = "psnr_pooled"
) -> dict[str, list[str]]:
    """Texels along a side of the shadow map equal to each method.

    Args:
        table: a row a method, with `lpips`, which may be empty, and a column of PSNRs in dB.
        methods: the rows' keys; those `shadow_map_N` among them are the maps to compare with.

    Returns: `map_lpips` and `map_psnr`, texts: `386`, `< 128` or `> 2048` outside the maps'
        sizes, and empty for these maps themselves and without two of them.
    """
    sizes = np.array([_size(method) for method in methods])
    return {
        "map_lpips": _texts(sizes, table["lpips"].to_numpy(float)),
        "map_psnr": _texts(sizes, mse_of(table[psnr])),
    }


def _size(method: str) -> float:
    """N of `shadow_map_N`, and NaN of any other method, maps that are filtered among them."""
    family, size = family_and_size(method)
    return size if family == "shadow_map" else np.nan


def _texts(sizes: np.ndarray, errors: np.ndarray) -> list[str]:
    usable = np.isfinite(sizes) & np.isfinite(errors)
    if usable.sum() < 2:
        return [""] * len(sizes)
    measured = sizes[usable].astype(int), errors[usable]
    return [
        "" if np.isfinite(size) or np.isnan(error) else _text(*measured, error)
        for size, error in zip(sizes, errors)
    ]


def _text(sizes: np.ndarray, errors: np.ndarray, error: float) -> str:
    if error < errors.min():
        return f"> {sizes.max()}"
    resolution = equivalent_resolution(sizes, errors, error)
    return f"< {sizes.min()}" if resolution is None else f"{resolution:.0f}"

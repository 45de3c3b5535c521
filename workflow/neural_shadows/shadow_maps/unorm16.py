"""Heights of a shadow map in 16 bits, as graphics hardware stores them."""

import numpy as np

from neural_shadows.shadow_maps.shadow_map import ShadowMapSquare

# Heights rounded at once, so that they stay in the cache.
_CHUNK = 65_536


def to_unorm16(heights: np.ndarray, square: ShadowMapSquare) -> np.ndarray:
    """Codes (uint16) of heights (float32, −∞ for none), in the same shape.

    Code 0 is left to texels without a surface; the others divide the object's extent along the
    light evenly, 3e-5 apart for the whole sphere: a third of the constant bias.
    """
    codes = np.empty(heights.shape, np.uint16)
    flat, flat_codes = heights.reshape(-1), codes.reshape(-1)
    for begin in range(0, len(flat), _CHUNK):
        chunk = slice(begin, begin + _CHUNK)
        steps = (flat[chunk].astype(np.float64) - square.lowest) / _step(square)
        flat_codes[chunk] = np.clip(np.round(steps) + 1, 0, 65_535)
    return codes


def from_unorm16(codes: np.ndarray, square: ShadowMapSquare) -> np.ndarray:
    """Heights (float32) of codes, in the same shape."""
    heights = square.lowest + _step(square) * (codes - 1.0)
    return np.where(codes > 0, heights, -np.inf).astype(np.float32)


def _step(square: ShadowMapSquare) -> float:
    return (square.highest - square.lowest) / 65_534 or 1.0  # of an object across the light: any

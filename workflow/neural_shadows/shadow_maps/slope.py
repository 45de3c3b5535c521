"""Depth bias of slanted receivers, in texels."""

import numpy as np

MOST_SLOPE = 20.0


def slope(cosines: np.ndarray, reach: float = 0.75) -> np.ndarray:
    """0.5 + reach tan θ, at most 20, by the cosines (n,) of θ, between normal and light.

    Args:
        reach: in texels, how far from a receiver's place its texel's depth may be.
    """
    # From 1 % up: tan θ = 26 reaches the bound anyway.
    tangent = np.sqrt(1 / np.clip(cosines, 0.01, 1) ** 2 - 1)
    return np.minimum(0.5 + reach * tangent, MOST_SLOPE)

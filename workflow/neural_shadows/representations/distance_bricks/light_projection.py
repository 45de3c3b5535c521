"""Projection of a field's blocks of cells on the tiles of a light's rays, see `LightTables`."""

import numpy as np
from numba import njit

_SLACK = 4e-3  # blocks, for a ray's rounding to 2^−20 cells a step
CLOSE = 1e-3  # blocks; nearer to a point light its rays spread over all tiles


@njit(cache=True, nogil=True, error_model="numpy")
def projection(start, end, light):
    """Projection of blocks between two depths on the tiles.

    Returns whether they lie behind the light, and for a and b a factor and a shift at each depth.

    Args:
        light: deep, near, source and low of `LightTables`.
    """
    deep, near, source, low = light
    if near:
        if end <= source[0]:
            return False, (0.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0)
        reach = deep - source[0]
        f, g = reach / max(start - source[0], CLOSE), reach / (end - source[0])
        a, b = source[1], source[2]
        return (
            True,
            (f, a - a * f - low[0], g, a - a * g - low[0]),
            (f, b - b * f - low[1], g, b - b * g - low[1]),
        )
    ahead, behind = float(deep - start), float(deep - end)
    return (
        True,
        (1.0, source[1] * ahead - low[0], 1.0, source[1] * behind - low[0]),
        (1.0, source[2] * ahead - low[1], 1.0, source[2] * behind - low[1]),
    )


@njit(cache=True, nogil=True)
def first_tile(cell, to):
    """First tile of rays through a cell."""
    return np.int64(np.floor(min(cell * to[0] + to[1], cell * to[2] + to[3]) - _SLACK))


@njit(cache=True, nogil=True)
def last_tile(cell, to):
    """Last tile of rays through a cell."""
    return np.int64(np.floor(max((cell + 1) * to[0] + to[1], (cell + 1) * to[2] + to[3]) + _SLACK))

"""Ray-traced texels of a shadow map, for few look-ups [4.1]."""

import numpy as np

from neural_shadows.scenes.tracing import Tracer
from neural_shadows.shadow_maps.shadow_map import ShadowMapSquare

# Rays traced at once: of 2048² texels in one piece the arrays would leave the cache, and
# take more than twice as long (1,331 ms of the dragon, in chunks 504).
_CHUNK = 65_536


def texel_heights(
    tracer: Tracer, square: ShadowMapSquare, resolution: int, texels: np.ndarray
) -> np.ndarray:
    """Height along the light of the first surface under each texel's centre, −∞ for none.

    Args:
        texels: (t,) row · resolution + column; `np.arange(resolution**2)` for the whole map.

    Returns:
        (t,) float32.
    """
    heights = np.empty(len(texels), np.float32)
    for begin in range(0, len(texels), _CHUNK):
        chunk = slice(begin, begin + _CHUNK)
        heights[chunk] = _heights(tracer, square, resolution, texels[chunk])
    return heights


def looked_up_heights(
    tracer: Tracer, square: ShadowMapSquare, resolution: int, texels: np.ndarray
) -> np.ndarray:
    """`texel_heights` of texels (t,) with many repeats."""
    if resolution**2 > 4 * len(texels):
        # Where texels outnumber receivers, few are shared (at 2048² a twentieth of 500,000): a ray
        # each is cheaper than finding the distinct ones in a table of the whole map.
        return texel_heights(tracer, square, resolution, texels)
    used = np.zeros(resolution**2, bool)
    used[texels] = True
    used = np.flatnonzero(used)
    table = np.empty(resolution**2, np.float32)
    table[used] = texel_heights(tracer, square, resolution, used)
    return table[texels]


def _heights(
    tracer: Tracer, square: ShadowMapSquare, resolution: int, texels: np.ndarray
) -> np.ndarray:
    u, v, light = square.basis
    row, column = np.divmod(texels, resolution)
    across = square.corner[0] + (column + 0.5) * (square.side / resolution)
    along = square.corner[1] + (row + 0.5) * (square.side / resolution)
    origins = np.empty((len(texels), 3), np.float32)
    for k in range(3):
        origins[:, k] = across * u[k] + along * v[k] + square.top * light[k]
    directions = np.tile(-light.astype(np.float32), (len(texels), 1))
    t, _ = tracer.first_hit(origins, directions)
    return np.float32(square.top) - t

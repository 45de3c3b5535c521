"""A light's map as moments of depth, filtered before receivers look them up.

Donnelly and Lauritzen 2006; the margin that a kernel needs at a cube's seams is in `face_views`, and
what the moments say of a receiver in `moments`.
"""

from collections.abc import Callable

import numpy as np
from numba import njit

from neural_shadows.shadow_maps.face_views import face_views
from neural_shadows.shadow_maps.light_map import LightMap
from neural_shadows.shadow_maps.moments import blurred

_BAND = 32  # rows filtered at once: of 1024 texels and four moments 1 MB


def filtered_moments(
    light_map: LightMap,
    depths: np.ndarray,
    ways: np.ndarray,
    *,
    of: Callable[[np.ndarray], np.ndarray],
    far: float,
    kernel: np.ndarray,
) -> np.ndarray:
    """The map's filtered moments where receivers look, bilinearly: (n, moments) float64.

    Filtered is only what receivers look into, a face at a time: of 2048² texels and four moments
    0.3 GB at most. In float64, since the fourth moments' differences are lost in float32.

    Args:
        depths: (texels,) float32 of the whole map. ways: (n, 3) from the light to receivers.
        of: the moments (…, moments) of depths (…) in [0, 1], such as `moments.powers`.
        far: the distance of depth 1, which also a texel that sees nothing has; receivers off the
            map find that depth.
        kernel: weights of an odd number of texels along rows and columns.
    """
    nothing = of(np.ones(1))[0]
    found = np.tile(nothing, (len(ways), 1))
    for view in face_views(light_map, depths, ways, len(kernel)):
        moments = _filtered(np.minimum(view.depths / np.float32(far), 1), of, kernel)
        _fill_bilinear(moments, view.places, len(kernel) // 2, view.receivers, found)
    return found


def _filtered(depths: np.ndarray, of: Callable, kernel: np.ndarray) -> np.ndarray:
    """Moments of depths (H, W) where the kernel is within, a band of rows after the other: those
    before the filter stay in the processor's cache.
    """
    less = len(kernel) - 1
    height, width = (size - less for size in depths.shape)
    found = np.empty((height, width, of(np.ones(1)).shape[1]))
    for k in range(0, height, _BAND):
        found[k : k + _BAND] = blurred(of(depths[k : k + _BAND + less]), kernel)
    return found


@njit(cache=True, nogil=True)
def _fill_bilinear(moments, places, reach, receivers, found):
    """Values (H, W, moments) at places (m, 2), of which all four neighbours are within.

    Args:
        reach: by how many rows and columns of the places the filter made the map smaller.
    """
    for i in range(len(places)):
        y, x = places[i, 0] - reach, places[i, 1] - reach
        row, column = int(y), int(x)
        down, right = y - row, x - column
        a, b = (1 - down) * (1 - right), (1 - down) * right
        c, d = down * (1 - right), down * right
        for k in range(moments.shape[2]):
            above = a * moments[row, column, k] + b * moments[row, column + 1, k]
            below = c * moments[row + 1, column, k] + d * moments[row + 1, column + 1, k]
            found[receivers[i], k] = above + below

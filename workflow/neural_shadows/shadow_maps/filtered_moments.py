"""Moments of depth of a light's map, filtered before the look-up.

Donnelly and Lauritzen 2006; the kernel's margin at a cube's seams is in `face_views`, the
visibility by moments in `moments`.
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
    from_light: np.ndarray,
    *,
    of: Callable[[np.ndarray], np.ndarray],
    far: float,
    kernel: np.ndarray,
) -> np.ndarray:
    """Look up filtered moments bilinearly: (n, moments) float64.

    Only the receivers' parts are filtered, a face at a time: of 2048² texels and four moments
    0.3 GB at most. In float64, since the fourth moments' differences are lost in float32.

    Args:
        depths: (texels,) float32 of the whole map. from_light: (n, 3) from the light to receivers.
        of: the moments (…, moments) of depths (…) in [0, 1], such as `moments.powers`.
        far: the distance of depth 1, also of empty texels, and for receivers off the map; the
            map's `near` has depth 0.
        kernel: weights of an odd number of texels along rows and columns.
    """
    empty = of(np.ones(1))[0]
    values = np.tile(empty, (len(from_light), 1))
    near, span = np.float32(light_map.near), np.float32(far - light_map.near)
    for view in face_views(light_map, depths, from_light, len(kernel)):
        moments = _filtered(np.minimum((view.depths - near) / span, 1), of, kernel)
        _fill_bilinear(moments, view.places, len(kernel) // 2, view.receivers, values)
    return values


def _filtered(depths: np.ndarray, of: Callable, kernel: np.ndarray) -> np.ndarray:
    """Filtered moments of depths (H, W) inside the rim, in cached bands."""
    margin = len(kernel) - 1
    height, width = (size - margin for size in depths.shape)
    values = np.empty((height, width, of(np.ones(1)).shape[1]))
    for k in range(0, height, _BAND):
        values[k : k + _BAND] = blurred(of(depths[k : k + _BAND + margin]), kernel)
    return values


@njit(cache=True, nogil=True)
def _fill_bilinear(moments, places, reach, receivers, values):
    """Fill in moments (H, W, moments) at places (m, 2), bilinearly.

    Args:
        reach: rows and columns of the places removed by the filter.
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
            values[receivers[i], k] = above + below

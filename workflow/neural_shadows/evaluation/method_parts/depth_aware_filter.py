"""A depth-aware screen-space filter (Datta et al. 2022, 4).

The paper gives no constants: cross-bilateral over 5 × 5 pixels.
"""

import numpy as np
from numba import njit

from neural_shadows.rendering.surface import Surface

_REACH = 2  # pixels to each side
_SIGMA_PIXELS = 1.5
_SIGMA_DEPTH = 0.01  # of a pixel's own distance to the eye


def depth_aware(surface: Surface, visibility: np.ndarray) -> np.ndarray:
    """Filter visibilities (n,) over near pixels of similar depth: float32.

    Pixels without a surface do not count.
    """
    distance = np.linalg.norm(surface.p - surface.camera.eye.astype(np.float32), axis=1)
    depth = surface.image(distance.astype(np.float32), np.inf)
    filtered = np.empty(len(visibility), np.float32)
    _filter(surface.pixel, depth, surface.image(visibility), filtered)
    return filtered


@njit(cache=True, nogil=True)
def _filter(pixels, depth, visibility, filtered):
    height, width = depth.shape
    for i in range(len(pixels)):
        row, column = pixels[i] // width, pixels[i] % width
        total, weights = 0.0, 0.0
        for y in range(max(row - _REACH, 0), min(row + _REACH + 1, height)):
            for x in range(max(column - _REACH, 0), min(column + _REACH + 1, width)):
                pixel_term = ((y - row) ** 2 + (x - column) ** 2) / _SIGMA_PIXELS**2
                depth_term = (depth[y, x] / depth[row, column] - 1) / _SIGMA_DEPTH
                weight = np.exp(
                    -0.5 * (pixel_term + depth_term**2)
                )  # 0 where the depth is infinite
                total += weight * visibility[y, x]
                weights += weight
        filtered[i] = total / weights

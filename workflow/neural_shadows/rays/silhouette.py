"""Silhouettes: texels covered by the object across a view direction [3.4.2].

The plane of a direction d goes through the origin, with the basis u, v of `plane_basis`; the
offset (a, b) is its point a·u + b·v. The square [−1, 1]² of it has `resolution`² texels: row i
is along b, column j along a, and the centre of texel (i, j) is at
(a, b) = ((2j + 1) / resolution − 1, (2i + 1) / resolution − 1).
"""

import math
from functools import lru_cache

import numpy as np
from numba import njit

from neural_shadows.rendering.perpendicular import perpendicular
from neural_shadows.scenes.tracing import Tracer


@njit(cache=True, nogil=True)
def plane_basis(direction):
    """Unit vectors u, v across a unit direction d, with u × v = d.

    See `perpendicular`. All (3,) float64.
    """
    u, v = perpendicular(direction[0], direction[1], direction[2])
    return np.array(u), np.array(v)


@njit(cache=True, nogil=True)
def entry_points(direction, offsets):
    """Entry points of rays along d (3,) into the unit sphere: (n, 3) float32 [3.4.2].

    o = a·u + b·v − √(1 − a² − b²)·d, for offsets (a, b) within the unit disk, (n, 2) float64.
    """
    u, v = plane_basis(direction)
    origins = np.empty((len(offsets), 3), np.float32)
    for i in range(len(offsets)):
        a, b = offsets[i]
        c = math.sqrt(max(0.0, 1 - a * a - b * b))
        for axis in range(3):
            origins[i, axis] = a * u[axis] + b * v[axis] - c * direction[axis]
    return origins


def silhouette(tracer: Tracer, direction: np.ndarray, resolution: int) -> np.ndarray:
    """Trace the object's silhouette along a unit vector (3,) [3.4.2].

    Returns:
        (resolution, resolution) bool, row b and column a: True where the ray through the
        texel's centre hits the object. Texels with their centre outside the unit disk are False.
    """
    centres, inside = _texel_centres(resolution)
    origins = entry_points(direction, centres)
    image = np.zeros((resolution, resolution), bool)
    along = np.broadcast_to(direction.astype(np.float32), origins.shape)
    image[inside] = tracer.occluded(origins, along)
    return image


@lru_cache(maxsize=2)
def _texel_centres(resolution: int) -> tuple[np.ndarray, np.ndarray]:
    """Offsets (n, 2) of the texel centres inside the unit disk, and the mask of those texels."""
    axis = (2 * np.arange(resolution) + 1) / resolution - 1
    a, b = np.meshgrid(axis, axis)
    inside = a**2 + b**2 < 1
    return np.stack([a[inside], b[inside]], axis=1), inside

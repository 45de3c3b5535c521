"""Entry of parallel rays into the unit sphere [3.6.1]."""

import numpy as np
from numba import njit


@njit(cache=True, nogil=True)
def enter_sphere(p, light, index, origins, s, chord):
    """Fill in the rays from a light to points p, without culled ones; return their number.

    Args:
        p: (m, 3) float32. light: (3,) float32, unit vector towards the light.
        index: (m,) int64, of each ray's point. origins: (m, 3) float32, entry points on the sphere.
        s, chord: (m,) float32, distances from there to the point, and to the sphere's other side.
    """
    u, v, w = light
    one, count = np.float32(1), 0
    for point in range(len(p)):
        x, y, z = p[point]
        along = x * u + y * v + z * w
        x, y, z = x - along * u, y - along * v, z - along * w
        half_chord_squared = one - (x * x + y * y + z * z)
        if half_chord_squared <= 0:
            continue
        half_chord = np.sqrt(half_chord_squared)
        if half_chord <= along:
            continue
        index[count] = point
        origins[count, 0] = x + half_chord * u
        origins[count, 1] = y + half_chord * v
        origins[count, 2] = z + half_chord * w
        s[count], chord[count] = half_chord - along, 2 * half_chord
        count += 1
    return count

"""A z-buffer of triangles."""

import numpy as np
from numba import njit


@njit(cache=True, nogil=True)
def drawn(x, y, z, faces, resolution):
    """Greatest z at texels' centres, (resolution, resolution) float32, else −∞.

    Vertices' x, y in texels and z are (V,) float64; between them z is linear in x and y.
    """
    heights = np.full((resolution, resolution), -np.inf, np.float32)
    last = resolution - 1
    for face in range(len(faces)):
        i, j, k = faces[face, 0], faces[face, 1], faces[face, 2]
        ax, ay, bx, by, cx, cy = x[i], y[i], x[j], y[j], x[k], y[k]
        columns = max(np.ceil(min(ax, bx, cx)), 0), min(np.floor(max(ax, bx, cx)), last)
        rows = max(np.ceil(min(ay, by, cy)), 0), min(np.floor(max(ay, by, cy)), last)
        turn = 1.0 if (bx - ax) * (cy - ay) - (by - ay) * (cx - ax) > 0 else -1.0
        for row in range(int(rows[0]), int(rows[1]) + 1):
            for column in range(int(columns[0]), int(columns[1]) + 1):
                # Each is made of differences to the texel's centre, so that the triangles on both
                # sides of an edge have the same number with opposite signs: no centre falls
                # between them.
                a = turn * ((bx - column) * (cy - row) - (by - row) * (cx - column))
                b = turn * ((cx - column) * (ay - row) - (cy - row) * (ax - column))
                c = turn * ((ax - column) * (by - row) - (ay - row) * (bx - column))
                whole = a + b + c
                if a >= 0 and b >= 0 and c >= 0 and whole > 0:
                    height = np.float32((a * z[i] + b * z[j] + c * z[k]) / whole)
                    if height > heights[row, column]:
                        heights[row, column] = height
    return heights

"""A z-buffer of triangles."""

import numpy as np
from numba import njit

# Columns of a triangle's box from which its edges tell where a row begins and ends: testing the texels of
# fewer takes less time.
_WIDE = 8


@njit(cache=True, nogil=True, error_model="numpy")
def drawn(x, y, z, faces, resolution):
    """Greatest z at texels' centres, (resolution, resolution) float32, else −∞.

    Vertices' x, y in texels and z are (V,) float64; between them z is linear in x and y.
    """
    heights = np.full((resolution, resolution), -np.inf, np.float32)
    last = resolution - 1
    for face in range(len(faces)):
        i, j, k = faces[face, 0], faces[face, 1], faces[face, 2]
        corners = (x[i], y[i]), (x[j], y[j]), (x[k], y[k])
        (ax, ay), (bx, by), (cx, cy) = corners
        left = int(max(np.ceil(min(ax, bx, cx)), 0))
        right = int(min(np.floor(max(ax, bx, cx)), last))
        top, bottom = max(np.ceil(min(ay, by, cy)), 0), min(np.floor(max(ay, by, cy)), last)
        turn = 1.0 if (bx - ax) * (cy - ay) - (by - ay) * (cx - ax) > 0 else -1.0
        for row in range(int(top), int(bottom) + 1):
            begin, end = left, right
            if right - left >= _WIDE:
                for p, q in ((1, 2), (2, 0), (0, 1)):
                    begin, end = _narrowed(begin, end, corners[p], corners[q], turn, row)
            first, begin = _inside(begin, end, 1, corners, turn, row, (z[i], z[j], z[k]))
            final, end = _inside(end, begin, -1, corners, turn, row, (z[i], z[j], z[k]))
            if begin <= end:
                _fill(heights[row], begin, end, first, final)
    return heights


@njit(cache=True, nogil=True, error_model="numpy")
def _narrowed(begin, end, p, q, turn, row):
    """Columns on a triangle's side of the edge from p to q, and a few more."""
    slope = turn * (p[1] - q[1])  # of the edge's function, along the row
    if slope == 0:
        return begin, end
    before, after = p[0] * (q[1] - row), q[0] * (p[1] - row)
    crossing = turn * (after - before) / slope
    margin = 1 + 1e-15 * (abs(before) + abs(after)) / abs(slope)  # more than is rounded
    if slope > 0:
        return max(begin, int(max(np.floor(crossing - margin), begin))), end
    return begin, int(min(np.ceil(crossing + margin), end))


@njit(cache=True, nogil=True, error_model="numpy")
def _inside(column, last, step, corners, turn, row, z):
    """Height of the first column inside, from one to another, and that column; beyond it for none."""
    (ax, ay), (bx, by), (cx, cy) = corners
    while (last - column) * step >= 0:
        # Each is made of differences to the texel's centre, so that the triangles on both sides of an
        # edge have the same number with opposite signs: no centre falls between them.
        a = turn * ((bx - column) * (cy - row) - (by - row) * (cx - column))
        b = turn * ((cx - column) * (ay - row) - (cy - row) * (ax - column))
        c = turn * ((ax - column) * (by - row) - (ay - row) * (bx - column))
        whole = a + b + c
        if a >= 0 and b >= 0 and c >= 0 and whole > 0:
            return (a * z[0] + b * z[1] + c * z[2]) / whole, column
        column += step
    return 0.0, column


@njit(cache=True, nogil=True, error_model="numpy")
def _fill(heights, begin, end, first, final):
    """Raise a row to heights linear between its ends."""
    slope = (final - first) / max(end - begin, 1)
    for column in range(begin, end + 1):
        height = np.float32(first + slope * (column - begin))
        heights[column] = height if height > heights[column] else heights[column]

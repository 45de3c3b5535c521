"""First crossing of rays with a height map."""

import numpy as np
from numba import njit

from neural_shadows.representations.depths import LIT


@njit(cache=True, nogil=True)
def first_crossings(origins, directions, ends, heights):
    """First crossings t (n,) float32 with the surface; `LIT` for misses.

    From either side. A cell is two triangles, parted by the line from its (1, 0) to its (0, 1).

    Args:
        origins, directions: (n, 3) float64 in units of the map: cells along its two axes, and
            steps of the heights.
        ends: (n,) float64, t at the rays' ends.
        heights: (r, r) of any unsigned type.
    """
    t_hit = np.full(len(origins), LIT, np.float32)
    cells = len(heights) - 1
    upper = np.array([cells, cells, np.iinfo(heights.dtype).max], np.float64)
    for ray in range(len(origins)):
        t, end = 0.0, ends[ray]
        for k in range(3):  # of the box around the map
            o, d = origins[ray, k], directions[ray, k]
            if d != 0:
                a, b = -o / d, (upper[k] - o) / d
                t, end = max(t, min(a, b)), min(end, max(a, b))
            elif not 0 <= o <= upper[k]:
                end = -1.0
        if t > end:
            continue
        ox, oy, oz = origins[ray]
        dx, dy, dz = directions[ray]
        ix = 1 / dx if dx != 0 else 0.0
        iy = 1 / dy if dy != 0 else 0.0
        across = 1 / (dx + dy) if dx + dy != 0 else 0.0
        i = min(max(int(ox + t * dx), 0), cells - 1)
        j = min(max(int(oy + t * dy), 0), cells - 1)
        first = True
        above = False
        while 0 <= i < cells and 0 <= j < cells and t <= end:
            tx = (i + (dx > 0) - ox) * ix if dx != 0 else np.inf
            ty = (j + (dy > 0) - oy) * iy if dy != 0 else np.inf
            leave = max(t, min(tx, ty, end))
            corners = (heights[i, j], heights[i + 1, j], heights[i, j + 1], heights[i + 1, j + 1])
            if first or not above or oz + dz * (leave if dz < 0 else t) <= max(corners):
                # On each triangle the height above the surface is linear in t.
                before = _above(ox + t * dx - i, oy + t * dy - j, oz + t * dz, corners)
                if not first and (before > 0) != above:  # by a rounding
                    t_hit[ray] = t
                    break
                first = False
                parting = (i + 1 + j - ox - oy) * across
                for after in (min(max(parting, t), leave), leave):
                    height = _above(
                        ox + after * dx - i, oy + after * dy - j, oz + after * dz, corners
                    )
                    if (height > 0) != (before > 0):
                        t_hit[ray] = t + (after - t) * before / (before - height)
                        break
                    t, before = after, height
                above = before > 0
                if t_hit[ray] < LIT:
                    break
            if leave >= end:
                break
            t = leave
            if tx <= ty:
                i += 1 if dx > 0 else -1
            else:
                j += 1 if dy > 0 else -1
    return t_hit


@njit(cache=True, nogil=True)
def _above(u, v, height, corners):
    """Height above the surface at u, v of a cell."""
    low, high = np.float64(corners[1]), np.float64(corners[2])
    if u + v <= 1:
        corner = np.float64(corners[0])
        return height - (corner + (low - corner) * u + (high - corner) * v)
    corner = np.float64(corners[3])
    return height - (corner + (high - corner) * (1 - u) + (low - corner) * (1 - v))

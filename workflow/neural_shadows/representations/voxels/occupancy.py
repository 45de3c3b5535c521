"""Cells of a grid, touched or enclosed by a surface."""

import numpy as np
from numba import njit
from scipy import ndimage

# Enlargement of tested cells, so that rounding misses none.
SLACK = 1.001


def surface_cells(
    vertices: np.ndarray, faces: np.ndarray, resolution: int, margin: float = 0.0
) -> np.ndarray:
    """Cells touched by a triangle, by separating axes (Akenine-Möller 2001).

    Args:
        vertices: (V, 3) positions in normalised space, inside [−1, 1]³.
        faces: (F, 3) vertex indices.
        resolution: cells along an axis, n.
        margin: around each cell, in sides.

    Returns:
        (n, n, n) bool, indexed by x, y, z.
    """
    touched = np.zeros((resolution,) * 3, bool)
    whole = np.asarray(vertices, np.float64), np.asarray(faces, np.int64)
    _mark_touched(*whole, SLACK + 2 * margin, touched)
    return touched


def enclosed_cells(surface: np.ndarray) -> np.ndarray:
    """Cells (n, n, n) bool enclosed by surface cells.

    No path of free cells, side by side, joins them to the outside. Holes of a mesh that are smaller
    than a cell do not open its inside.
    """
    return ndimage.binary_fill_holes(surface) & ~surface


@njit(cache=True, nogil=True)
def _mark_touched(vertices, faces, slack, touched):
    n = len(touched)
    size = 2.0 / n
    half = size / 2 * slack
    first = np.empty(3, np.int64)
    last = np.empty(3, np.int64)
    centre = np.empty(3)
    for f in range(len(faces)):
        corners = vertices[faces[f]]
        for axis in range(3):
            low, high = corners[:, axis].min(), corners[:, axis].max()
            first[axis] = max(0, int(np.floor((low + 1 - (half - size / 2)) / size)))
            last[axis] = min(n - 1, int(np.floor((high + 1 + (half - size / 2)) / size)))
        for x in range(first[0], last[0] + 1):
            centre[0] = (x + 0.5) * size - 1
            for y in range(first[1], last[1] + 1):
                centre[1] = (y + 0.5) * size - 1
                for z in range(first[2], last[2] + 1):
                    centre[2] = (z + 0.5) * size - 1
                    if not touched[x, y, z]:
                        touched[x, y, z] = touches(corners - centre, half)


@njit(cache=True, nogil=True)
def touches(corners, half):
    """Test a triangle (3, 3) against a centred cube.

    The cube has this half side. The triangle's bounding box must already overlap it.
    """
    edges = corners[np.array([1, 2, 0])] - corners
    if _separates(np.cross(edges[0], edges[1]), corners, half):
        return False
    axis = np.empty(3)
    for i in range(3):
        for k in range(3):
            axis[k] = 0
            axis[(k + 1) % 3] = -edges[i, (k + 2) % 3]
            axis[(k + 2) % 3] = edges[i, (k + 1) % 3]
            if _separates(axis, corners, half):
                return False
    return True


@njit(cache=True, nogil=True)
def _separates(axis, corners, half):
    reach = half * (abs(axis[0]) + abs(axis[1]) + abs(axis[2]))
    low, high = np.inf, -np.inf
    for i in range(3):
        along = axis[0] * corners[i, 0] + axis[1] * corners[i, 1] + axis[2] * corners[i, 2]
        low, high = min(low, along), max(high, along)
    return low > reach or high < -reach

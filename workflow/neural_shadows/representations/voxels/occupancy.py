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
    corners, low, high = np.empty((3, 3)), np.empty(3), np.empty(3)
    for f in range(len(faces)):
        take_corners(vertices, faces[f], corners, low, high)
        for axis in range(3):
            first[axis] = max(0, int(np.floor((low[axis] + 1 - (half - size / 2)) / size)))
            last[axis] = min(n - 1, int(np.floor((high[axis] + 1 + (half - size / 2)) / size)))
        for x in range(first[0], last[0] + 1):
            for y in range(first[1], last[1] + 1):
                for z in range(first[2], last[2] + 1):
                    if not touched[x, y, z]:
                        cx, cy, cz = (
                            (x + 0.5) * size - 1,
                            (y + 0.5) * size - 1,
                            (z + 0.5) * size - 1,
                        )
                        touched[x, y, z] = touches(corners, cx, cy, cz, half)


# Below rows are filled by loops: as slices and with np.cross the file took 3.1 s to compile, not 1.0.
@njit(cache=True, nogil=True)
def take_corners(vertices, face, corners, low, high):
    """Fill in a triangle's corners (3, 3) and the ends of its bounding box (3,)."""
    for axis in range(3):
        for i in range(3):
            corners[i, axis] = vertices[face[i], axis]
        low[axis] = min(corners[0, axis], corners[1, axis], corners[2, axis])
        high[axis] = max(corners[0, axis], corners[1, axis], corners[2, axis])


@njit(cache=True, nogil=True)
def touches(triangle, x, y, z, half):
    """Test a triangle (3, 3) against a cube about a point.

    The cube has this half side. The triangle's bounding box must already overlap it.
    """
    corners, edges, axis = np.empty((3, 3)), np.empty((3, 3)), np.empty(3)
    for i in range(3):
        corners[i, 0], corners[i, 1] = triangle[i, 0] - x, triangle[i, 1] - y
        corners[i, 2] = triangle[i, 2] - z
    for i in range(3):
        for k in range(3):
            edges[i, k] = corners[(i + 1) % 3, k] - corners[i, k]
    for k in range(3):  # the normal
        a, b = (k + 1) % 3, (k + 2) % 3
        axis[k] = edges[0, a] * edges[1, b] - edges[0, b] * edges[1, a]
    if _separates(axis, corners, half):
        return False
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

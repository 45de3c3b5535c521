"""Quadtrees over silhouettes: small quads along the silhouette's border [3.4.2]."""

import math

import numpy as np
from numba import njit

# Radius of the disk of quads and points, just inside the unit disk, so that no ray is a
# tangent: o·d <= -1e-3, and a chord has a length of 2e-3 at least.
DISK_RADIUS = math.sqrt(1 - 1e-6)


@njit(cache=True, nogil=True)
def build_quadtree(silhouette, min_quad):
    """Leaves of the quadtree over a silhouette [3.4.2].

    The one square that covers the disk is split, and so is every quad of more than `min_quad`
    texels that is neither wholly inside nor wholly outside the silhouette. Quads wholly
    outside the disk (of `DISK_RADIUS`) are dropped.

    Args:
        silhouette: (resolution, resolution) bool; the resolution is a power of two.
        min_quad: side of the smallest quads in texels, a power of two up to the resolution.

    Returns:
        (q, 3) int32, each (row, column, size) in texels, in the Z-order of the quads.
    """
    resolution = len(silhouette)
    # sums[i, j]: covered texels above row i and left of column j, for the count in any quad.
    sums = np.zeros((resolution + 1, resolution + 1), np.int32)
    for i in range(resolution):
        in_row = 0
        for j in range(resolution):
            in_row += silhouette[i, j]
            sums[i + 1, j + 1] = sums[i, j + 1] + in_row

    leaves = np.empty(((resolution // min_quad) ** 2, 3), np.int32)
    count = 0
    # Depth first, three waiting siblings a level at most: 2^32 texels a side fit.
    stack = np.empty((100, 3), np.int64)
    _put(stack, 0, 0, 0, resolution)
    waiting = 1
    while waiting > 0:
        waiting -= 1
        row, column, size = stack[waiting, 0], stack[waiting, 1], stack[waiting, 2]
        if not _meets_disk(row, column, size, resolution):
            continue
        covered = (
            sums[row + size, column + size]
            - sums[row, column + size]
            - sums[row + size, column]
            + sums[row, column]
        )
        if size == min_quad or covered == 0 or covered == size * size:
            _put(leaves, count, row, column, size)
            count += 1
            continue
        half = size // 2
        _put(stack, waiting, row + half, column + half, half)
        _put(stack, waiting + 1, row + half, column, half)
        _put(stack, waiting + 2, row, column + half, half)
        _put(stack, waiting + 3, row, column, half)
        waiting += 4
    return leaves[:count].copy()


@njit(cache=True, nogil=True)
def _put(quads, i, row, column, size):
    """Set a row; to assign it as a whole takes numba seconds to compile."""
    quads[i, 0], quads[i, 1], quads[i, 2] = row, column, size


@njit(cache=True, nogil=True)
def disk_area(left, bottom, right, top):
    """Area of a rectangle inside the disk of `DISK_RADIUS`."""
    return (
        _corner_area(right, top)
        - _corner_area(left, top)
        - _corner_area(right, bottom)
        + _corner_area(left, bottom)
    )


@njit(cache=True, nogil=True)
def _corner_area(x, y):
    """Signed disk area between the axes and (x, y); odd in both."""
    radius = DISK_RADIUS
    sign = 1.0 if (x < 0) == (y < 0) else -1.0
    x, y = min(abs(x), radius), min(abs(y), radius)
    if x * x + y * y <= radius * radius:
        return sign * x * y
    # Under the line up to where it leaves the disk, under the circle from there on.
    leaves = math.sqrt(radius * radius - y * y)
    return sign * (leaves * y + _under_circle(x) - _under_circle(leaves))


@njit(cache=True, nogil=True)
def _under_circle(x):
    """Integral of √(radius² − s²) over s from 0 to x."""
    radius = DISK_RADIUS
    height = math.sqrt(max(0.0, radius * radius - x * x))
    return (x * height + radius * radius * math.asin(min(1.0, x / radius))) / 2


@njit(cache=True, nogil=True)
def _meets_disk(row, column, size, resolution):
    """Test whether the quad meets the disk, by its nearest point."""
    # In half texels from the centre, where all corners are whole numbers.
    near_a = max(2 * column - resolution, resolution - 2 * (column + size), 0)
    near_b = max(2 * row - resolution, resolution - 2 * (row + size), 0)
    return near_a**2 + near_b**2 < (DISK_RADIUS * resolution) ** 2

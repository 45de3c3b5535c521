"""Signed distances of brick vertices near an open sheet.

A sheet has no inside: the sign is the side of the nearest face. Beyond a sheet's border, and between
two sheets, signs of both sides meet where there is no surface. So only cells that the sheet touches
may be crossed.
"""

import numpy as np
from numba import njit

from neural_shadows.meshes.prepared_mesh import PreparedMesh
from neural_shadows.representations.distance_bricks.brick_distances import squared_distance
from neural_shadows.representations.distance_bricks.brick_layout import BrickLayout
from neural_shadows.representations.distance_bricks.field_marching import BRICK
from neural_shadows.representations.voxels.occupancy import touches

# Around a brick, in cells: a ray's samples before and behind a crossing are up to half a cell away.
MARGIN = 0.6
# Half a side of what counts as a cell, in sides: interpolated surfaces lie up to a tenth of a cell
# beside the sheet, in the neighbour of a cell that it touches.
_HALF = 0.5 + 0.15
_SAME = 1e-5  # relative difference of squared distances to a point of two faces


def sheet_distances(
    mesh: PreparedMesh, layout: BrickLayout, reach: float
) -> tuple[np.ndarray, np.ndarray]:
    """Distance of each brick vertex to a sheet, and the cells that it touches.

    Args:
        mesh: with faces of one winding where they meet.
        reach: largest distance, in cells.

    Returns:
        (count,) float32 in cells within [−reach, reach], positive behind the faces; and (bricks,)
        uint64, bit 16 x + 4 y + z of each cell touched.
    """
    half = len(layout.grid) * BRICK / 2  # cells in a radius
    corners = ((mesh.vertices.astype(np.float64) + 1) * half)[mesh.faces]
    squared, heights = np.full(layout.count, reach**2), np.zeros(layout.count)
    cells = np.zeros(len(layout.table), np.uint64)
    normals = mesh.face_normals.astype(np.float64)
    _scatter(corners, normals, layout.grid, layout.table, float(reach), squared, heights, cells)
    distances = np.where(heights > 0, -1, 1) * np.sqrt(squared)
    return distances.astype(np.float32), cells


@njit(cache=True, nogil=True)
def _scatter(corners, normals, grid, table, reach, squared, heights, cells):
    """Fill in touched cells, and by vertex the nearest face's distance and height over it.

    Of faces that meet in the nearest point the one that the vertex is highest over tells the side:
    seen from there the others may face away.
    """
    size = len(grid)
    first = np.empty(3, np.int64)
    last = np.empty(3, np.int64)
    middle = np.empty(3)
    for f in range(len(corners)):
        for axis in range(3):
            first[axis] = np.ceil(corners[f, :, axis].min() - reach)
            last[axis] = np.floor(corners[f, :, axis].max() + reach)
        # A vertex on a border belongs to the bricks on either side.
        low = np.maximum((first - 1) // BRICK, 0)
        high = np.minimum(last // BRICK, size - 1)
        for bx in range(low[0], high[0] + 1):
            for by in range(low[1], high[1] + 1):
                for bz in range(low[2], high[2] + 1):
                    brick = grid[bx, by, bz]
                    if brick < 0:
                        continue
                    for x in range(max(first[0], BRICK * bx), min(last[0], BRICK * bx + 4) + 1):
                        for y in range(max(first[1], BRICK * by), min(last[1], BRICK * by + 4) + 1):
                            for z in range(
                                max(first[2], BRICK * bz), min(last[2], BRICK * bz + 4) + 1
                            ):
                                i, j, k = x - BRICK * bx, y - BRICK * by, z - BRICK * bz
                                vertex = table[brick, (i * 5 + j) * 5 + k]
                                _lower(corners[f], normals[f], x, y, z, vertex, squared, heights)
                                if i == BRICK or j == BRICK or k == BRICK:
                                    continue
                                middle[0], middle[1], middle[2] = x + 0.5, y + 0.5, z + 0.5
                                bit = np.uint64(1) << np.uint64(BRICK**2 * i + BRICK * j + k)
                                if cells[brick] & bit == 0 and _touched(corners[f], middle):
                                    cells[brick] |= bit


@njit(cache=True, nogil=True)
def _touched(corners, middle):
    """Test a triangle (3, 3) against the cell about a point (3,)."""
    for axis in range(3):
        if corners[:, axis].min() - middle[axis] > _HALF:
            return False
        if corners[:, axis].max() - middle[axis] < -_HALF:
            return False
    return touches(corners - middle, _HALF)


@njit(cache=True, nogil=True)
def _lower(corners, normal, x, y, z, vertex, squared, heights):
    """Take a triangle for a vertex if none is nearer."""
    a, farthest = corners[0], squared[vertex] * (1 + _SAME)
    height = normal[0] * (x - a[0]) + normal[1] * (y - a[1]) + normal[2] * (z - a[2])
    if height * height > farthest:
        return
    distance = squared_distance(corners, x, y, z)
    if distance > farthest:
        return
    if distance < squared[vertex] * (1 - _SAME) or abs(height) > abs(heights[vertex]):
        squared[vertex] = min(distance, squared[vertex])
        heights[vertex] = height

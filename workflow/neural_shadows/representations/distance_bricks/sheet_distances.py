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
# Around a cell, in cells: interpolated surfaces lie up to a tenth of a cell beside the sheet, in the
# neighbour of a cell that it touches.
_BESIDE = 0.15
_SAME = 1e-5  # relative difference of distances to a point of two faces


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
    nearest, heights = np.full(layout.count, float(reach)), np.zeros(layout.count)
    cells = np.zeros(len(layout.table), np.uint64)
    _mark_touched(corners, layout.grid, cells)
    normals = mesh.face_normals.astype(np.float64)
    _scatter(corners, normals, layout.grid, layout.table, float(reach), nearest, heights)
    return np.where(heights > 0, -nearest, nearest).astype(np.float32), cells


@njit(cache=True, nogil=True)
def _mark_touched(corners, grid, cells):
    """Set the bits of cells touched by triangles (F, 3, 3), in cells."""
    most, half = BRICK * len(grid) - 1, 0.5 + _BESIDE
    low, high = np.empty(3, np.int64), np.empty(3, np.int64)
    middle = np.empty(3)
    for f in range(len(corners)):
        for axis in range(3):
            low[axis] = max(int(np.floor(corners[f, :, axis].min() - _BESIDE)), 0)
            high[axis] = min(int(np.floor(corners[f, :, axis].max() + _BESIDE)), most)
        for x in range(low[0], high[0] + 1):
            for y in range(low[1], high[1] + 1):
                for z in range(low[2], high[2] + 1):
                    brick = grid[x // BRICK, y // BRICK, z // BRICK]
                    at = (x % BRICK * BRICK + y % BRICK) * BRICK + z % BRICK
                    bit = np.uint64(1) << np.uint64(at)
                    if brick < 0 or cells[brick] & bit:
                        continue
                    middle[0], middle[1], middle[2] = x + 0.5, y + 0.5, z + 0.5
                    if touches(corners[f] - middle, half):
                        cells[brick] |= bit


@njit(cache=True, nogil=True)
def _scatter(corners, normals, grid, table, reach, nearest, heights):
    """Fill in the nearest face's distance, and the height over it, of each vertex.

    Of faces that meet in the nearest point the one that the vertex is highest over tells the side:
    seen from there the others may face away.
    """
    size = len(grid)
    first = np.empty(3, np.int64)
    last = np.empty(3, np.int64)
    for f in range(len(corners)):
        for axis in range(3):
            first[axis] = np.ceil(corners[f, :, axis].min() - reach)
            last[axis] = np.floor(corners[f, :, axis].max() + reach)
        ball = _ball(corners[f])
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
                                at = ((x - BRICK * bx) * 5 + y - BRICK * by) * 5 + z - BRICK * bz
                                vertex = table[brick, at]
                                # Most have a nearer face already.
                                reached = nearest[vertex] * (1 + _SAME) + ball[3]
                                if _squared(ball, x, y, z) < reached * reached:
                                    of_face = corners[f], normals[f], x, y, z
                                    _lower(*of_face, vertex, nearest, heights)


@njit(cache=True, nogil=True, inline="always")
def _ball(corners):
    """Middle of a triangle's corners, and radius of the ball around it."""
    x, y, z = corners[:, 0].mean(), corners[:, 1].mean(), corners[:, 2].mean()
    square = 0.0
    for k in range(3):
        square = max(square, _squared((x, y, z), corners[k, 0], corners[k, 1], corners[k, 2]))
    return x, y, z, np.sqrt(square)


@njit(cache=True, nogil=True, inline="always")
def _squared(place, x, y, z):
    return (place[0] - x) ** 2 + (place[1] - y) ** 2 + (place[2] - z) ** 2


@njit(cache=True, nogil=True)
def _lower(corners, normal, x, y, z, vertex, nearest, heights):
    """Take a triangle for a vertex if none is nearer."""
    a, farthest = corners[0], nearest[vertex] * (1 + _SAME)
    height = normal[0] * (x - a[0]) + normal[1] * (y - a[1]) + normal[2] * (z - a[2])
    if abs(height) > farthest:
        return
    distance = np.sqrt(squared_distance(corners, x, y, z))
    if distance > farthest:
        return
    if distance < nearest[vertex] * (1 - _SAME) or abs(height) > abs(heights[vertex]):
        nearest[vertex] = min(distance, nearest[vertex])
        heights[vertex] = height

"""Signed distances of brick vertices near an open sheet.

A sheet has no inside: the sign is the side of the nearest face. Beyond a sheet's border, and between
two sheets, signs of both sides meet where there is no surface. So only cells that the sheet touches
may be crossed.
"""

import numpy as np
from numba import njit

from neural_shadows.meshes.prepared_mesh import PreparedMesh
from neural_shadows.representations.distance_bricks.brick_distances import (
    REACH,
    has_brick,
    squared_distance,
    take_box,
    take_triangle,
)
from neural_shadows.representations.distance_bricks.brick_layout import BrickLayout
from neural_shadows.representations.distance_bricks.field_marching import BRICK
from neural_shadows.representations.voxels.occupancy import touches

# Around a brick, in cells: a ray's samples before and behind a crossing are up to half a cell away.
MARGIN = 0.6
# Half a side of what counts as a cell, in sides: interpolated surfaces lie up to a tenth of a cell
# beside the sheet, in the neighbour of a cell that it touches.
_HALF = 0.5 + 0.15
_SAME = 1e-5  # relative difference of squared distances to a point of two faces


def sheet_distances(mesh: PreparedMesh, layout: BrickLayout) -> tuple[np.ndarray, np.ndarray]:
    """Distance of each brick vertex to a sheet, and the cells that it touches.

    Args:
        mesh: with faces of one winding where they meet.

    Returns:
        (count,) float32 in cells within [−REACH, REACH], positive behind the faces; and (bricks,)
        uint64, bit 16 x + 4 y + z of each cell touched.
    """
    half = len(layout.grid) * BRICK / 2  # cells in a radius
    vertices = (mesh.vertices.astype(np.float64) + 1) * half
    squared, heights = np.full(layout.count, REACH**2), np.zeros(layout.count)
    cells = np.zeros(len(layout.table), np.uint64)
    triangles = vertices, mesh.faces, mesh.face_normals.astype(np.float64)
    _scatter(*triangles, layout.grid, layout.table, REACH, squared, heights, cells)
    distances = np.where(heights > 0, -1, 1) * np.sqrt(squared)
    return distances.astype(np.float32), cells


@njit(cache=True, nogil=True)
def _scatter(vertices, faces, normals, grid, table, reach, squared, heights, cells):
    """Fill in touched cells, and by vertex the nearest face's distance and height over it.

    Of faces that meet in the nearest point the one that the vertex is highest over tells the side:
    seen from there the others may face away.

    Args:
        vertices: (V, 3), in cells. faces, normals: (F, 3).
    """
    corners = np.empty((3, 3))
    first, low, high = np.empty(3, np.int64), np.empty(3, np.int64), np.empty(3, np.int64)
    last = np.empty(3, np.int64)
    for f in range(len(faces)):
        cx, cy, cz, radius = take_triangle(vertices, faces[f], corners)
        take_box(corners, reach, len(grid), first, last, low, high)
        for bx in range(low[0], high[0] + 1):
            for by in range(low[1], high[1] + 1):
                for bz in range(low[2], high[2] + 1):
                    brick = grid[bx, by, bz]
                    if brick < 0:
                        continue
                    # Vertices on its far sides are those of the next bricks, where there are any.
                    x0, y0, z0 = BRICK * bx, BRICK * by, BRICK * bz
                    x_end = min(last[0], x0 + BRICK - has_brick(grid, bx + 1, by, bz))
                    y_end = min(last[1], y0 + BRICK - has_brick(grid, bx, by + 1, bz))
                    z_end = min(last[2], z0 + BRICK - has_brick(grid, bx, by, bz + 1))
                    for x in range(max(first[0], x0), x_end + 1):
                        for y in range(max(first[1], y0), y_end + 1):
                            at = ((x - x0) * 5 + y - y0) * 5 - z0
                            across = (x - cx) ** 2 + (y - cy) ** 2
                            for z in range(max(first[2], z0), z_end + 1):
                                vertex = table[brick, at + z]
                                limit = np.sqrt(squared[vertex]) * (1 + _SAME) + radius
                                if across + (z - cz) ** 2 <= limit * limit:
                                    _lower(corners, normals[f], x, y, z, vertex, squared, heights)
        _touch(corners, grid, first, last, cells)


@njit(cache=True, nogil=True)
def _touch(corners, grid, first, last, cells):
    """Mark the cells touched by a triangle (3, 3); `first` and `last` (3,) are overwritten."""
    margin = _HALF - 0.5
    for axis in range(3):
        a, b, c = corners[0, axis], corners[1, axis], corners[2, axis]
        first[axis] = max(np.int64(np.floor(min(a, b, c) - margin)), 0)
        last[axis] = min(np.int64(np.floor(max(a, b, c) + margin)), BRICK * len(grid) - 1)
    for x in range(first[0], last[0] + 1):
        for y in range(first[1], last[1] + 1):
            for z in range(first[2], last[2] + 1):
                brick = grid[x // BRICK, y // BRICK, z // BRICK]
                i, j, k = x % BRICK, y % BRICK, z % BRICK
                bit = np.uint64(1) << np.uint64(BRICK**2 * i + BRICK * j + k)
                if brick >= 0 and cells[brick] & bit == 0:
                    if touches(corners, x + 0.5, y + 0.5, z + 0.5, _HALF):
                        cells[brick] |= bit


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

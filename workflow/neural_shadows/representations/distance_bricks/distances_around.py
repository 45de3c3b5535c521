"""Distances from a field's cube to its surface, by its own values."""

import numpy as np
from numba import njit

from neural_shadows.representations.distance_bricks.field_marching import BRICK, SOLID


def distances_around(grid: np.ndarray, bricks: np.ndarray) -> np.ndarray:
    """Distance of each brick corner to the surface, negative inside.

    (B + 1,) * 3 float32, in radii of the cube [−1, 1]³. Corners four cells apart suffice beyond a
    brick's own values: twice as many along an axis lower a cone's squared errors on the Stanford
    dragon by 5 to 8 %.

    Args:
        grid: (B, B, B) int32, see `BrickLayout`.
        bricks: (bricks, 125), values of each brick's vertices, positive inside; at least one
            crosses 0.
    """
    squared = np.full((len(grid) + 1,) * 3, np.inf, np.float32)
    _propagate(_crossings(grid, bricks), squared)
    away = np.sqrt(squared) * np.float32(2 / len(grid))
    return np.where(_corners_inside(grid, bricks), -away, away)


# The 13 neighbours before a corner in a sweep.
_BEFORE = np.array([offset for offset in np.ndindex(3, 3, 3) if offset < (1, 1, 1)]) - 1


@njit(cache=True, nogil=True)
def _propagate(points, squared):
    """Lower `squared` to corners' squared distances to nearest points.

    Points (n, 3) float32. A corner takes a point from its neighbours, in sweeps to and fro
    (Danielsson 1980). A search tree was a hundred times slower on a sphere, with all points equally
    far inside.
    """
    size = len(squared)
    nearest = np.full((size + 2, size + 2, size + 2), -1, np.int32)  # padded by a corner
    for n in range(len(points)):
        for x in range(int(points[n, 0]), min(int(points[n, 0]) + 2, size)):
            for y in range(int(points[n, 1]), min(int(points[n, 1]) + 2, size)):
                for z in range(int(points[n, 2]), min(int(points[n, 2]) + 2, size)):
                    if _offer(points, n, x, y, z, squared):
                        nearest[x + 1, y + 1, z + 1] = n
    nearest_of = nearest.ravel()
    away = _BEFORE[:, 0] * (size + 2) ** 2 + _BEFORE[:, 1] * (size + 2) + _BEFORE[:, 2]
    for sweep in range(4):
        direction = 1 - 2 * (sweep % 2)
        begin, end = (0, size) if direction > 0 else (size - 1, -1)
        for x in range(begin, end, direction):
            for y in range(begin, end, direction):
                for z in range(begin, end, direction):
                    at = ((x + 1) * (size + 2) + y + 1) * (size + 2) + z + 1
                    for k in range(len(away)):
                        n = nearest_of[at + direction * away[k]]
                        # Most have the same point already.
                        if n >= 0 and n != nearest_of[at] and _offer(points, n, x, y, z, squared):
                            nearest_of[at] = n


@njit(cache=True, nogil=True)
def _offer(points, n, x, y, z, squared):
    a, b, c = points[n, 0] - x, points[n, 1] - y, points[n, 2] - z
    distance = a * a + b * b + c * c
    nearer = distance < squared[x, y, z]
    if nearer:
        squared[x, y, z] = distance
    return nearer


def _crossings(grid: np.ndarray, bricks: np.ndarray) -> np.ndarray:
    """Zero crossings on cell edges: (n, 3) in bricks from the corner −1."""
    corner = np.argwhere(grid >= 0)  # of each brick
    values = bricks[grid[grid >= 0]].reshape(-1, *[BRICK + 1] * 3).astype(np.float32)
    points = []
    for axis in range(3):
        lower, upper = (np.take(values, range(k, k + BRICK), axis + 1) for k in (0, 1))
        brick, *cell = np.nonzero((lower > 0) != (upper > 0))
        a, b = lower[brick, *cell], upper[brick, *cell]
        cell = np.stack(cell, axis=1).astype(np.float32)
        cell[:, axis] += a / (a - b)
        points.append(corner[brick] + cell / BRICK)
        points += [_border_crossings(grid, corner, values, axis, far) for far in (False, True)]
    return np.concatenate(points).astype(np.float32)


def _border_crossings(
    grid: np.ndarray, corner: np.ndarray, values: np.ndarray, axis: int, far: bool
) -> np.ndarray:
    """Sign changes (n, 3) on one side of bricks, next to empty or solid ones.

    A wall on the border of bricks crosses 0 nowhere within them.
    """
    follows = corner.copy()
    follows[:, axis] += 1 if far else -1
    beyond = np.pad(grid, 1, constant_values=-1)[tuple(follows.T + 1)]
    side = np.take(values, BRICK if far else 0, axis + 1) > 0
    brick, *vertex = np.nonzero(
        (beyond < 0)[:, None, None] & (side != (beyond == SOLID)[:, None, None])
    )
    vertex.insert(axis, np.full(len(brick), BRICK if far else 0))
    return corner[brick] + np.stack(vertex, axis=1) / BRICK


def _corners_inside(grid: np.ndarray, bricks: np.ndarray) -> np.ndarray:
    """Mask of brick corners inside: (B + 1,) * 3 bool."""
    size = len(grid)
    inside = np.zeros((size + 1,) * 3, bool)
    held = grid >= 0
    for offset in np.ndindex(2, 2, 2):
        part = inside[tuple(slice(k, k + size) for k in offset)]
        part |= grid == SOLID
        vertex = np.ravel_multi_index(np.multiply(offset, BRICK), (BRICK + 1,) * 3)
        part[held] |= bricks[grid[held], vertex] > 0
    return inside

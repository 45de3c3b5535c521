"""How far a field's surface is from anywhere in its cube, of the field's own values."""

import numpy as np
from numba import njit

from neural_shadows.networks.object_space.field_marching import BRICK, SOLID


def distances_around(grid: np.ndarray, bricks: np.ndarray) -> np.ndarray:
    """Distance of each brick's corner to the surface, negative inside: (B + 1,) * 3 float32.

    In radii of the cube [−1, 1]³. Four cells apart they are enough where a brick's own values end:
    with twice as many along an axis a cone's squared errors on the Stanford dragon were 5 to 8 % less.

    Args:
        grid: (B, B, B) int32, see `BrickLayout`.
        bricks: (bricks, 125), values of each brick's vertices, positive inside. One at least
            crosses 0.
    """
    squared = np.full((len(grid) + 1,) * 3, np.inf, np.float32)
    _spread(_crossings(grid, bricks), squared)
    away = np.sqrt(squared) * np.float32(2 / len(grid))
    return np.where(_corners_inside(grid, bricks), -away, away)


@njit(cache=True, nogil=True)
def _spread(points, squared):
    """Lower `squared` to the squared distance of each corner to its nearest point (n, 3) float32.

    A corner learns of a point from its neighbours, in sweeps to and fro (Danielsson 1980). A search
    tree was a hundred times as slow on a sphere, whose inside is as far from all of it.
    """
    size = len(squared)
    nearest = np.full((size, size, size), -1, np.int32)
    for n in range(len(points)):
        for x in range(int(points[n, 0]), min(int(points[n, 0]) + 2, size)):
            for y in range(int(points[n, 1]), min(int(points[n, 1]) + 2, size)):
                for z in range(int(points[n, 2]), min(int(points[n, 2]) + 2, size)):
                    _offer(points, n, x, y, z, nearest, squared)
    for sweep in range(4):
        way = 1 - 2 * (sweep % 2)
        for step in range(size**3):
            at = step if way > 0 else size**3 - 1 - step
            x, y, z = at // (size * size), at // size % size, at % size
            for k in range(13):  # the neighbours that come before it
                i, j, h = x + way * (k // 9 - 1), y + way * (k // 3 % 3 - 1), z + way * (k % 3 - 1)
                if min(i, j, h) >= 0 and max(i, j, h) < size and nearest[i, j, h] >= 0:
                    _offer(points, nearest[i, j, h], x, y, z, nearest, squared)


@njit(cache=True, nogil=True, inline="always")
def _offer(points, n, x, y, z, nearest, squared):
    a, b, c = points[n, 0] - x, points[n, 1] - y, points[n, 2] - z
    found = a * a + b * b + c * c
    if found < squared[x, y, z]:
        squared[x, y, z], nearest[x, y, z] = found, n


def _crossings(grid: np.ndarray, bricks: np.ndarray) -> np.ndarray:
    """Where edges of the bricks' cells cross 0, (n, 3) in bricks from the corner −1."""
    corner = np.argwhere(grid >= 0)  # of the bricks, by their numbers
    values = bricks[grid[grid >= 0]].reshape(-1, *[BRICK + 1] * 3).astype(np.float32)
    found = []
    for axis in range(3):
        lower, upper = (np.take(values, range(k, k + BRICK), axis + 1) for k in (0, 1))
        brick, *place = np.nonzero((lower > 0) != (upper > 0))
        a, b = lower[brick, *place], upper[brick, *place]
        place = np.stack(place, axis=1).astype(np.float32)
        place[:, axis] += a / (a - b)
        found.append(corner[brick] + place / BRICK)
        found += [_ends(grid, corner, values, axis, far) for far in (False, True)]
    return np.concatenate(found).astype(np.float32)


def _ends(
    grid: np.ndarray, corner: np.ndarray, values: np.ndarray, axis: int, far: bool
) -> np.ndarray:
    """Vertices (n, 3) on one side of the bricks that are inside, and what follows is empty, or the
    other way round: a wall on the border of bricks crosses 0 nowhere within them.
    """
    follows = corner.copy()
    follows[:, axis] += 1 if far else -1
    beyond = np.pad(grid, 1, constant_values=-1)[tuple(follows.T + 1)]
    side = np.take(values, BRICK if far else 0, axis + 1) > 0
    brick, *place = np.nonzero(
        (beyond < 0)[:, None, None] & (side != (beyond == SOLID)[:, None, None])
    )
    place.insert(axis, np.full(len(brick), BRICK if far else 0))
    return corner[brick] + np.stack(place, axis=1) / BRICK


def _corners_inside(grid: np.ndarray, bricks: np.ndarray) -> np.ndarray:
    """Whether each brick's corner is inside: (B + 1,) * 3 bool."""
    size = len(grid)
    inside = np.zeros((size + 1,) * 3, bool)
    held = grid >= 0
    for offset in np.ndindex(2, 2, 2):
        part = inside[tuple(slice(k, k + size) for k in offset)]
        part |= grid == SOLID
        vertex = np.ravel_multi_index(np.multiply(offset, BRICK), (BRICK + 1,) * 3)
        part[held] |= bricks[grid[held], vertex] > 0
    return inside

"""Procedural terrain as a survey scans it: eroded ridges, boulders and noise; an open sheet.

In metres; y is up, over a square of `SIDE`. Land rises evenly and rivers cut it, until both are nearly
level (the implicit scheme of Braun and Willett 2013, A very efficient O(n) method to solve the stream
power equation).
"""

import numpy as np
from numba import njit
from scipy import ndimage

from neural_shadows.meshes.height_grid import height_grid

SIDE = 3000.0
HIGHEST = 750.0
# The eroded grid: cells along a side at first, and steps of erosion, by how often they are halved. Large
# valleys come first, and are kept.
COARSEST, STEPS = 40, (60, 30, 15, 8)
CUT = 0.1  # of a river, by the root of its cells
SOFT = 0.8  # cells, of slopes that slide
BOULDERS, BOULDER = 4000, (2.0, 8.0)  # and their radii in metres
NOISE = 0.12  # metres, of a scanner


def make_terrain(*, cells: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Vertices ((cells + 1)², 3) float64 and faces (2 cells², 3) int64.

    Faces are wound counter-clockwise from above.

    Args:
        cells: grid cells along a side.
    """
    rng = np.random.default_rng(seed)
    side = np.linspace(-SIDE / 2, SIDE / 2, cells + 1)
    heights = _land(rng, cells + 1) + _boulders(rng, side)
    heights += rng.normal(0, NOISE, heights.shape)
    x, z = np.meshgrid(side, side, indexing="ij")
    return height_grid(x, heights, z)


def _land(rng: np.random.Generator, count: int) -> np.ndarray:
    """Eroded heights (count, count) in metres."""
    cells = COARSEST
    land = rng.uniform(0, 1, (cells + 1, cells + 1))
    for level, steps in enumerate(STEPS):
        if level:
            cells *= 2
            land = _interpolated(land, cells + 1) + rng.uniform(0, 0.6, (cells + 1, cells + 1))
        _erode(land, steps, CUT)
        land = ndimage.gaussian_filter(land, SOFT)
    land = _interpolated(land, count)
    return land * (HIGHEST / land.max())


def _interpolated(values: np.ndarray, count: int) -> np.ndarray:
    """Cubic interpolation of a square of values, (count, count)."""
    place = np.linspace(0, len(values) - 1, count)
    grid = np.meshgrid(place, place, indexing="ij")
    return ndimage.map_coordinates(values, grid, order=3, mode="nearest")


def _erode(heights: np.ndarray, steps: int, cut: float) -> None:
    """Let land rise within its rim, and rivers cut it; in place."""
    for _ in range(steps):
        heights[1:-1, 1:-1] += 1
        # Sorted here: compiled by Numba, a sort takes four seconds before its first use.
        _cut(heights.ravel(), *_steepest(heights), np.argsort(heights, axis=None), cut)


@njit(cache=True, nogil=True)
def _steepest(heights):
    """Each cell's neighbour of steepest descent, or itself, and its distance: (n²,)."""
    n = len(heights)
    to, far = np.empty(n * n, np.int64), np.empty(n * n)
    for i in range(n):
        for j in range(n):
            at = i * n + j
            to[at], far[at], steepest = at, 1.0, 0.0
            for x in range(max(i - 1, 0), min(i + 2, n)):
                for y in range(max(j - 1, 0), min(j + 2, n)):
                    away = np.sqrt(float((x - i) ** 2 + (y - j) ** 2))
                    if away > 0 and (heights[i, j] - heights[x, y]) / away > steepest:
                        steepest = (heights[i, j] - heights[x, y]) / away
                        to[at], far[at] = x * n + y, away
    return to, far


@njit(cache=True, nogil=True)
def _cut(flat, to, far, order, cut):
    """Lower cells, from the lowest up, by the water that flows to their neighbours; in place."""
    area = np.ones(len(flat))
    for at in order[::-1]:
        if to[at] != at:
            area[to[at]] += area[at]
    for at in order:
        if to[at] != at:
            share = cut * np.sqrt(area[at]) / far[at]
            flat[at] = (flat[at] + share * flat[to[at]]) / (1 + share)


def _boulders(rng: np.random.Generator, side: np.ndarray) -> np.ndarray:
    """Half balls on the ground: (count, count) metres."""
    heights, step = np.zeros((len(side), len(side))), side[1] - side[0]
    for x, z in rng.uniform(side[0], side[-1], (BOULDERS, 2)):
        radius = rng.uniform(*BOULDER)
        i, j = (np.flatnonzero(np.abs(side - place) < radius + step) for place in (x, z))
        square = radius**2 - (side[i, None] - x) ** 2 - (side[None, j] - z) ** 2
        ball = np.sqrt(np.maximum(square, 0))
        heights[np.ix_(i, j)] = np.maximum(heights[np.ix_(i, j)], ball)
    return heights

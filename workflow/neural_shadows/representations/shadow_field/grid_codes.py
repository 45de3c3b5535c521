"""The grid of a field's bricks in one byte each, as files and shaders have it."""

import numpy as np

from neural_shadows.representations.distance_bricks.field_marching import SOLID

HELD, SOLID_CODE = 0, 255  # of a brick; others: number of bricks that a ray may skip


def grid_codes(grid: np.ndarray) -> np.ndarray:
    """Codes of a grid's bricks, uint8; see `BrickLayout`."""
    codes = np.where(grid >= 0, HELD, np.minimum(-grid, SOLID_CODE - 1))
    codes[grid == SOLID] = SOLID_CODE
    return codes.astype(np.uint8)


def grid_of(codes: np.ndarray) -> np.ndarray:
    """Grid of codes, int32; bricks are numbered in the order of their places."""
    grid = -codes.astype(np.int32)
    grid[codes == SOLID_CODE] = SOLID
    held = codes == HELD
    grid[held] = np.arange(held.sum())
    return grid

"""Layout of the bricks with values in a cubic grid."""

from typing import NamedTuple

import numpy as np

from neural_shadows.representations.distance_bricks.field_marching import (
    BRICK,
    BRICK_VERTICES,
    SOLID,
    skips,
)
from neural_shadows.representations.voxels.occupancy import enclosed_cells


class BrickLayout(NamedTuple):
    """Layout of the values of a set of bricks."""

    grid: np.ndarray  # (B, B, B) int32: the brick's number, −distance if empty, or SOLID
    table: np.ndarray  # (bricks, 125) int32, indices of the values
    vertices: np.ndarray  # (count, 3) int32, their positions in cells from the corner −1

    @property
    def count(self) -> int:
        """Number of values: vertices of all bricks, shared ones once."""
        return len(self.vertices)


def lay_out(surface: np.ndarray, solid: bool) -> BrickLayout:
    """Number surface bricks (B, B, B) bool and their vertices."""
    size = len(surface)
    grid = -skips(surface)
    grid[surface] = np.arange(surface.sum())
    if solid:
        grid[enclosed_cells(surface)] = SOLID
    corner = BRICK * np.argwhere(surface)
    offsets = np.stack(np.unravel_index(np.arange(BRICK_VERTICES), (BRICK + 1,) * 3), axis=1)
    positions = (corner[:, None] + offsets).reshape(-1, 3).T
    # A vertex's id is its index in the whole grid, int64: 1025³ exceeds int32.
    whole = (BRICK * size + 1,) * 3
    ids, table = np.unique(np.ravel_multi_index(tuple(positions), whole), return_inverse=True)
    table = table.reshape(-1, BRICK_VERTICES).astype(np.int32)
    return BrickLayout(grid, table, np.stack(np.unravel_index(ids, whole), axis=1).astype(np.int32))

"""The bricks with values of a cubic grid over [−1, 1]³."""

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
    """Where the values of a set of bricks are."""

    grid: np.ndarray  # (B, B, B) int32: the brick's number, −distance if empty, or SOLID
    table: np.ndarray  # (bricks, 125) int32, into the values
    places: np.ndarray  # (count, 3) int32, where the values are, in cells from the corner −1

    @property
    def count(self) -> int:
        """How many values there are: the vertices of all bricks, shared ones once."""
        return len(self.places)


def lay_out(surface: np.ndarray, solid: bool) -> BrickLayout:
    """Number the bricks (B, B, B) bool that hold values, and their vertices."""
    size = len(surface)
    grid = -skips(surface)
    grid[surface] = np.arange(surface.sum())
    if solid:
        grid[enclosed_cells(surface)] = SOLID
    corner = BRICK * np.argwhere(surface)
    offsets = np.stack(np.unravel_index(np.arange(BRICK_VERTICES), (BRICK + 1,) * 3), axis=1)
    places = (corner[:, None] + offsets).reshape(-1, 3).T
    # A vertex's place in the whole grid is its name, in int64: 1025³ is past int32's end.
    whole = (BRICK * size + 1,) * 3
    used, table = np.unique(np.ravel_multi_index(tuple(places), whole), return_inverse=True)
    table = table.reshape(-1, BRICK_VERTICES).astype(np.int32)
    return BrickLayout(
        grid, table, np.stack(np.unravel_index(used, whole), axis=1).astype(np.int32)
    )

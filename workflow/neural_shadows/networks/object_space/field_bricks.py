"""What a CPU holds of a solid's field to answer whether a point is in shadow."""

from typing import NamedTuple

import numpy as np

from neural_shadows.networks.object_space.field_marching import BRICK, SOLID

# Rows of `FieldBricks.masks` before those of bricks with values.
EMPTY, ENCLOSED, FIRST = 0, 1, 2
# Empty bricks around the box. A ray's tile is half a brick wide and its four bricks two: a ray that
# is asked to look at a brick may look at those up to two beside it.
PAD = 2


class FieldBricks(NamedTuple):
    """The bricks of a box around all that is not empty, and which of their cells are inside."""

    size: int  # bricks along an axis of the whole cube [−1, 1]³
    corner: np.ndarray  # (3,) int64, the whole cube's brick at the box's corner, may be below 0
    grid: np.ndarray  # (X, Y, Z) uint16 or uint32, the row of each brick of the box
    masks: np.ndarray  # (rows, 2) uint64, bit 16 x + 4 y + z: any, and every corner is positive
    values: np.ndarray  # (rows − FIRST, 125), of each brick's vertices on any one scale
    level: np.float32  # the value at the surface; what is above is positive

    @property
    def bytes(self) -> int:
        """In memory."""
        return self.grid.nbytes + self.masks.nbytes + self.values.nbytes


def field_bricks(grid: np.ndarray, values: np.ndarray, level: float) -> FieldBricks:
    """Those of a field.

    Args:
        grid: (B, B, B) int32, see `BrickLayout`.
        values: (bricks, 125), float or int8.
        level: the value at the surface, on their scale.
    """
    held = np.argwhere((grid >= 0) | (grid == SOLID))
    low, high = (held.min(0), held.max(0) + 1) if len(held) else (np.zeros(3, int),) * 2
    box = grid[tuple(slice(*ends) for ends in zip(low, high))]
    rows = np.select([box >= 0, box == SOLID], [box + FIRST, ENCLOSED], EMPTY)
    kind = np.uint16 if len(values) + FIRST <= 1 << 16 else np.uint32
    masks = np.zeros((len(values) + FIRST, 2), np.uint64)
    masks[ENCLOSED] = ~np.uint64(0)
    level = np.float32(level)
    positive = (values > level).reshape(-1, *[BRICK + 1] * 3)
    masks[FIRST:, 0] = _cells(positive, np.logical_or)
    masks[FIRST:, 1] = _cells(positive, np.logical_and)
    return FieldBricks(len(grid), low - PAD, np.pad(rows.astype(kind), PAD), masks, values, level)


def _cells(positive: np.ndarray, combined: np.ufunc) -> np.ndarray:
    """The corners (n, 5, 5, 5) bool of each cell, combined, as (n,) uint64."""
    for axis in (1, 2, 3):
        lower, upper = (np.take(positive, range(k, k + BRICK), axis) for k in (0, 1))
        positive = combined(lower, upper)
    bits = np.packbits(positive.reshape(-1, BRICK**3), axis=1, bitorder="little")
    return bits.view("<u8").reshape(-1).astype(np.uint64)

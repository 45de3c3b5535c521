"""A field in CPU memory for shadow tests."""

from typing import NamedTuple

import numpy as np
from scipy import ndimage

from neural_shadows.representations.distance_bricks.cell_words import CELL, WORDS, fill_words
from neural_shadows.representations.distance_bricks.field_marching import BRICK, NO_CELLS, SOLID

# Rows of `FieldBricks.masks` before those of crossed bricks. A sheet's bricks may be all on one side,
# `OUTER` or `ENCLOSED`; a solid's, with enclosed ones all around, `DEEP`: no ray from outside
# meets them first.
EMPTY, ENCLOSED, OUTER, DEEP, FIRST = 0, 1, 2, 3, 4
# Empty bricks around the box. A ray is sampled where others of its tile pass cells: up to two blocks
# beside them, of a brick at most, and a sample before and after.
PAD = 3
NODE = 4  # bricks along a node
# Bits of a coordinate in 2^−CELL cells, within a brick and within a node.
BRICK_BITS, NODE_BITS = CELL + 2, CELL + 4


class FieldBricks(NamedTuple):
    """Bricks of a box around everything nonempty, with cell masks.

    Brick (x, y, z) of the box has row `rows[nodes[x // 4, y // 4, z // 4] + 16 (x % 4) + 4 (y % 4)
    + z % 4]`. A cell that is crossed has the word `words[first[row] + …]`, after those of the
    crossed cells with lower bits.
    """

    sheet: bool  # an open surface, which has sides and no inside
    density: int  # planes of samples through a cell, 2 or 4
    size: int  # bricks along an axis of the whole cube [−1, 1]³
    corner: np.ndarray  # (3,) int64, the cube's brick at the box's corner, may be negative
    shape: tuple[int, int, int]  # of the box, in bricks
    nodes: np.ndarray  # (X, Y, Z) uint32, each node's first row; empty nodes share theirs
    rows: np.ndarray  # (64 a nonempty node, and 64,) uint16 or uint32
    # (rows, 2) uint64, bit 16 x + 4 y + z: any, and every corner is positive. A sheet's cell
    # whose sides are unknown has the latter alone.
    masks: np.ndarray
    first: np.ndarray  # (rows,) uint32
    words: np.ndarray  # (crossed cells,) uint32 or uint64, see `cell_words`

    @property
    def bytes(self) -> int:
        """Size in memory."""
        return sum(part.nbytes for part in self if isinstance(part, np.ndarray))


def field_bricks(
    grid: np.ndarray,
    values: np.ndarray,
    level: float,
    corner_bits: int,
    cells: np.ndarray = NO_CELLS,
    density: int = 2,
) -> FieldBricks:
    """Build the bricks of a field.

    Args:
        grid: (B, B, B) int32, see `BrickLayout`.
        values: (bricks, 125), float or int8.
        level: the value at the surface, on their scale.
        corner_bits: 4 or 8, of each corner of a crossed cell.
        cells: those that a sheet may cross, see `first_crossings`; of a solid `NO_CELLS`.
        density: see `FieldBricks`. Distances that are fitted to the Stanford dragon at 256³ err as
            often by 2 as by 4 (0.105 and 0.110 % of a frame's rays), a trained field less by 4 (0.21
            and 0.18 %), in 1.3 times the time.
    """
    level, sheet = np.float32(level), len(cells) > 0
    positive = (values > level).reshape(-1, *[BRICK + 1] * 3)
    any_in, all_in = (_cells(positive, combined) for combined in (np.logical_or, np.logical_and))
    if sheet:
        unknown = any_in & ~all_in & ~cells
        any_in, all_in = any_in & ~unknown, all_in | unknown
    crossed = any_in & ~all_in
    held = crossed != 0
    if sheet:
        held |= all_in & ~any_in != 0
        uniform = np.where(any_in != 0, ENCLOSED, OUTER)
    else:
        uniform = np.where(any_in != 0, ENCLOSED, EMPTY)
    # The last row is for bricks without values.
    row = np.append(uniform, EMPTY)
    row[:-1][held] = FIRST + np.arange(held.sum())
    rows = np.where(grid == SOLID, ENCLOSED, row[np.maximum(grid, -1)])
    if not sheet:
        rows[ndimage.binary_erosion(rows == ENCLOSED, np.ones((3, 3, 3)))] = DEEP
    occupied = np.argwhere(rows != EMPTY)
    low, high = (occupied.min(0), occupied.max(0) + 1) if len(occupied) else (np.zeros(3, int),) * 2
    rows = np.pad(rows[tuple(slice(*ends) for ends in zip(low, high))], PAD)

    masks = np.zeros((FIRST + held.sum(), 2), np.uint64)
    masks[EMPTY] = 0, ~np.uint64(0) if sheet else 0
    masks[[ENCLOSED, DEEP]] = ~np.uint64(0)
    masks[FIRST:] = np.stack([any_in, all_in], axis=1)[held]
    first = np.zeros(len(masks) + 1, np.uint32)
    first[1:] = np.cumsum(np.bitwise_count(masks[:, 0] & ~masks[:, 1]))
    words = np.empty(first[-1], WORDS[corner_bits])
    fill_words(values[held], level, crossed[held], words)
    dtype = np.uint16 if len(masks) <= 1 << 16 else np.uint32
    nodes, rows_of_nodes = _in_nodes(rows.astype(dtype))
    bricks = nodes, rows_of_nodes, masks, first[:-1].copy(), words
    return FieldBricks(sheet, density, len(grid), low - PAD, rows.shape, *bricks)


def _in_nodes(rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Group rows of a box into nodes: `FieldBricks.nodes` and `.rows`."""
    rows = np.pad(rows, [(0, -side % NODE) for side in rows.shape])
    shape = [side // NODE for side in rows.shape]
    parts = rows.reshape(shape[0], NODE, shape[1], NODE, shape[2], NODE)
    parts = parts.transpose(0, 2, 4, 1, 3, 5).reshape(-1, NODE**3)
    held = (parts != EMPTY).any(axis=1)
    nodes = (NODE**3 * held * np.cumsum(held)).astype(np.uint32).reshape(shape)
    return nodes, np.concatenate([np.full(NODE**3, EMPTY, rows.dtype), parts[held].ravel()])


def _cells(positive: np.ndarray, combined: np.ufunc) -> np.ndarray:
    """Combine corners (n, 5, 5, 5) bool of each cell: (n,) uint64."""
    for axis in (1, 2, 3):
        lower, upper = (np.take(positive, range(k, k + BRICK), axis) for k in (0, 1))
        positive = combined(lower, upper)
    bits = np.packbits(positive.reshape(-1, BRICK**3), axis=1, bitorder="little")
    return bits.view("<u8").reshape(-1).astype(np.uint64)

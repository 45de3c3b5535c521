"""The fields of several solids one after the other in memory, and one ray's walk through one."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numba import njit

from neural_shadows.networks.object_space.cell_words import CELL, positive_in_brick
from neural_shadows.networks.object_space.field_bricks import (
    EMPTY,
    ENCLOSED,
    FIRST,
    NODE,
    PAD,
    FieldBricks,
)
from neural_shadows.networks.object_space.field_marching import skips

SAMPLES = 8  # along a brick, as `occupancy_field_network.SAMPLES_PER_CELL` has them
SOLID = -(1 << 15)
_BRICK = CELL + 2  # bits in which a brick's cells are counted, see `cell_words`
_FIXED = float(1 << _BRICK)


class FieldSet(NamedTuple):
    """Bricks of all fields; a field is one box of them."""

    # (fields, 5) int64: where its box begins in `grid`, and its X, Y, Z, and the number of its first
    # brick that is crossed.
    shapes: np.ndarray
    # int16 or int32: a crossed brick's number among its field's, SOLID, or how many bricks all round
    # are empty, below 0.
    grid: np.ndarray
    masks: np.ndarray  # (bricks, 2) uint64, see `FieldBricks`
    first: np.ndarray  # (bricks,) uint32, each one's first word
    words: np.ndarray  # (crossed cells,), see `cell_words`

    @property
    def bytes(self) -> int:
        """In memory."""
        return sum(part.nbytes for part in self)


def field_set(fields: Sequence[FieldBricks]) -> FieldSet:
    """Some fields, with as many bits a corner, as one, and without what is around each one's box."""
    shapes, grids, firsts, bricks, words = [], [], [], 0, 0
    for field in fields:
        box = _rows(field)[PAD:-PAD, PAD:-PAD, PAD:-PAD].astype(np.int32)
        free = skips(box != EMPTY)
        shapes.append((sum(map(np.size, grids)), *box.shape, bricks))
        grids.append(np.select([box == EMPTY, box == ENCLOSED], [-free, SOLID], box - FIRST))
        firsts.append(field.first[FIRST:] + np.uint32(words))
        bricks, words = bricks + len(firsts[-1]), words + len(field.words)
    kind = np.int16 if max(map(len, firsts)) <= 1 << 15 else np.int32
    return FieldSet(
        np.array(shapes, np.int64),
        np.concatenate([grid.ravel() for grid in grids]).astype(kind),
        np.concatenate([field.masks[FIRST:] for field in fields]),
        np.concatenate(firsts),
        np.concatenate([field.words for field in fields]),
    )


def _rows(field: FieldBricks) -> np.ndarray:
    """The row of each brick of a field's box, (X, Y, Z)."""
    x, y, z = np.indices(field.shape)
    nodes = field.nodes[x // NODE, y // NODE, z // NODE]
    return field.rows[nodes + (x % NODE * NODE + y % NODE) * NODE + z % NODE]


def to_box(field: FieldBricks) -> np.ndarray:
    """From places in [−1, 1]³ to bricks from the corner of a field's box in a set: (4, 4) float64."""
    half = field.size / 2
    found = np.diag([half, half, half, 1.0])
    found[:3, 3] = half - (field.corner + PAD)
    return found


@njit(cache=True, nogil=True, inline="always")
def meets(told, number, x, y, z, u, v, w, begin, end):
    """Whether a field is positive at any of a ray's samples between `begin` and `end`.

    Samples are 1 / SAMPLES of a brick apart.

    Args:
        told: the parts of a `FieldSet`. number: of the field.
        x, y, z: where the ray starts, in bricks from the box's corner. u, v, w: its way there.
        begin, end: in ways, where the ray is inside the box.
    """
    shapes, grid, masks, first, words = told
    start, first_brick = shapes[number, 0], shapes[number, 4]
    size_x, size_y, size_z = shapes[number, 1], shapes[number, 2], shapes[number, 3]
    length = np.sqrt(u * u + v * v + w * w)
    count = np.int64((end - begin) * length * SAMPLES + 0.5)
    step = _FIXED / (length * SAMPLES)
    dx, dy, dz = np.int64(u * step), np.int64(v * step), np.int64(w * step)
    # The first sample lies half a step behind `begin`.
    at_x = np.int64((x + begin * u) * _FIXED) + (dx >> 1)
    at_y = np.int64((y + begin * v) * _FIXED) + (dy >> 1)
    at_z = np.int64((z + begin * w) * _FIXED) + (dz >> 1)
    over_x, over_y, over_z = _over(dx), _over(dy), _over(dz)
    k = 0
    while k < count:
        px, py, pz = at_x + k * dx, at_y + k * dy, at_z + k * dz
        i, j, h = px >> _BRICK, py >> _BRICK, pz >> _BRICK
        if not (0 <= i < size_x and 0 <= j < size_y and 0 <= h < size_z):
            k += 1  # on the box's side, by rounding
            continue
        brick = np.int64(grid[start + (i * size_y + j) * size_z + h])
        if brick == SOLID:
            return True
        # The ray leaves the brick, or the cube of empty ones around it, before sample `until`.
        free = -brick if brick < 0 else 1
        until = min(
            _to_leave(px, i, free, dx, over_x),
            _to_leave(py, j, free, dy, over_y),
            _to_leave(pz, h, free, dz, over_z),
        )
        until = min(k + np.int64(until) + 1, count)
        if brick < 0:
            k = until
            continue
        brick += first_brick
        some, every, word = masks[brick, 0], masks[brick, 1], first[brick]
        while k < until:
            if positive_in_brick(some, every, word, words, px, py, pz):
                return True
            k += 1
            px, py, pz = px + dx, py + dy, pz + dz
    return False


@njit(cache=True, nogil=True, inline="always")
def _over(step):
    """1 over a step along an axis; of none, so much that no side of a brick is ever met."""
    return 1 / step if step != 0 else -1e30


@njit(cache=True, nogil=True, inline="always")
def _to_leave(place, brick, free, step, over):
    """How many steps stay within so many bricks of this one along an axis: their part is cut off."""
    side = ((brick + free) << _BRICK) - 1 if step > 0 else (brick + 1 - free) << _BRICK
    return (side - place) * over

"""Tables of one directional light over a field's bricks.

All its rays share them.

The bricks are looked at in layers across the axis that the light mostly follows, and where the rays
pass the first layer, in tiles of half a brick. Each tile has the layers in which any of its rays
can meet a brick that is not empty, so that a ray never walks through empty ones; and by which layer
all of its rays have met an enclosed one, behind which nothing is lit. Of a row of tiles only those
from the first to the last are held whose rays can meet anything.
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from neural_shadows.representations.distance_bricks.field_bricks import (
    EMPTY,
    ENCLOSED,
    NODE,
    PAD,
    FieldBricks,
)
from neural_shadows.representations.distance_bricks.field_marching import BRICK

TILES = 2  # along a brick. With 1 rays look at a third more layers; 4 take four times the memory
PARTS = 16  # of a brick's side, by which rays differ in `LightTables.cells`
NEVER = 255  # in `LightTables.enclosed`: by no layer, or by none that fits into 8 bits
_SLACK = 1e-3  # bricks, for roundings of float32
_LIGHTS = 64  # that `most_bytes` tries


class LightTables(NamedTuple):
    """Of a light along d: a ray is at u = a − slope_a m and v = b − slope_b m, wherever it is.

    m, a and b are coordinates in bricks from the box's corner along `axes`; layers are counted
    along the ray, from the first that holds any brick; cells as in `FieldBricks`. Tile (i, j) of
    u and v has number `offsets[i]` + j, if that is from `ends[i]` to before `ends[i + 1]`.
    """

    axes: tuple[int, int, int]  # that d mostly follows, and the two others
    slopes: tuple[float, float]  # of the two others, in [−1, 1]
    low: tuple[float, float]  # u and v where the tiles begin
    offsets: np.ndarray  # (U,) int32
    ends: np.ndarray  # (U + 1,) int32
    layers: np.ndarray  # (tiles, words) uint64, a bit for each layer in which a brick may be met
    enclosed: np.ndarray  # (tiles,) uint8, the first layer in which an enclosed brick is surely met
    # (PARTS², 4) uint64: the cells of 2 × 2 bricks in a layer that a ray can pass which enters the
    # layer in this part of the first of them, the one with its smallest a and b.
    cells: np.ndarray
    slabs: np.ndarray  # (4,) uint64, the cells of a brick in each quarter of a layer

    @property
    def bytes(self) -> int:
        """In memory."""
        return sum(part.nbytes for part in self if isinstance(part, np.ndarray))


def light_tables(bricks: FieldBricks, d: np.ndarray, step: float) -> LightTables:
    """Those of a field for rays along d (3,).

    Args:
        step: from sample to sample on a ray, in bricks.
    """
    d = np.asarray(d, np.float64)
    m = int(np.abs(d).argmax())
    axes = m, (m + 1) % 3, (m + 2) % 3
    depth, *across = (bricks.shape[axis] for axis in axes)
    slopes = tuple(float(d[axis] / d[m]) for axis in axes[1:])
    back = bool(d[m] < 0)
    # A tile more on each side, for the slack.
    low = tuple(-max(slope, 0.0) * depth - 1 / TILES for slope in slopes)
    rows, columns = (
        int(np.ceil((side + abs(slope) * depth) * TILES)) + 3 for side, slope in zip(across, slopes)
    )
    places = _places(bricks.nodes, bricks.rows, np.array(axes))
    firsts, lasts = np.full(rows, columns), np.zeros(rows, np.int64)
    _find_spans(places, slopes, low, firsts, lasts)
    ends = np.append(0, np.cumsum(np.maximum(lasts - firsts, 0))).astype(np.int32)
    offsets = (ends[:-1] - firsts).astype(np.int32)
    layers = np.zeros((ends[-1], -(-(depth - 2 * PAD) // 64)), np.uint64)
    enclosed = np.full(ends[-1], NEVER, np.uint8)
    tiles = offsets, ends, layers, enclosed
    _fill(places, depth, slopes, back, low, step, tiles)
    shifts = np.array([4, 2, 0])[list(axes)]
    cells, slabs = np.zeros((PARTS**2, 4), np.uint64), np.zeros(BRICK, np.uint64)
    _pass_cells(slopes, shifts, back, cells, slabs)
    return LightTables(axes, slopes, low, *tiles, cells, slabs)


def most_bytes(bricks: FieldBricks) -> int:
    """Of the tables of lights from all around, the largest: those of the diagonals, and others."""
    diagonals = np.stack(np.unravel_index(np.arange(8), (2, 2, 2)), axis=1) - 0.5
    others = np.random.default_rng(0).normal(size=(_LIGHTS, 3))
    return max(light_tables(bricks, d, 1.0).bytes for d in (*diagonals, *others))


@njit(cache=True, nogil=True)
def _places(nodes, rows, axes):
    """Of each brick that is not empty: m, a, b, and whether it is enclosed: (n, 4) int64."""
    found, count = np.empty((len(rows), 4), np.int64), 0
    at = np.empty(3, np.int64)
    for x, y, z in np.ndindex(nodes.shape):
        if nodes[x, y, z] == 0:
            continue
        for inner in range(NODE**3):
            row = rows[nodes[x, y, z] + inner]
            if row == EMPTY:
                continue
            at[0], at[1], at[2] = (
                x * NODE + (inner >> 4),
                y * NODE + (inner >> 2 & 3),
                z * NODE + (inner & 3),
            )
            for k in range(3):
                found[count, k] = at[axes[k]]
            found[count, 3] = row == ENCLOSED
            count += 1
    return found[:count]


@njit(cache=True, nogil=True)
def _find_spans(places, slopes, low, firsts, lasts):
    """Of each row of tiles, the first whose rays can meet a brick, and the one after the last."""
    for n in range(len(places)):
        m, a, b = places[n, 0], places[n, 1], places[n, 2]
        i, i_end = _shadow(a, m, slopes[0], low[0])
        j, j_end = _shadow(b, m, slopes[1], low[1])
        for u in range(i, i_end):
            firsts[u] = min(firsts[u], j)
            lasts[u] = max(lasts[u], j_end)


@njit(cache=True, nogil=True)
def _fill(places, depth, slopes, back, low, step, tiles):
    """Enter each brick into the tiles whose rays can meet it."""
    offsets, _, layers, enclosed = tiles
    # A sample lies this near to any height of a ray, so that one close to it lies beside it.
    near = step / 2 + _SLACK
    for n in range(len(places)):
        m, a, b = places[n, 0], places[n, 1], places[n, 2]
        layer = depth - 1 - PAD - m if back else m - PAD
        word, bit = layer >> 6, np.uint64(1) << np.uint64(layer & 63)
        i, i_end = _shadow(a, m, slopes[0], low[0])
        j, j_end = _shadow(b, m, slopes[1], low[1])
        for u in range(i, i_end):
            for v in range(j, j_end):
                layers[offsets[u] + v, word] |= bit
        if places[n, 3] == 0:
            continue
        for height in (m + 0.25, m + 0.75):
            i, i_end = _covered(a - slopes[0] * height - low[0], near)
            j, j_end = _covered(b - slopes[1] * height - low[1], near)
            for u in range(i, i_end):
                for v in range(j, j_end):
                    enclosed[offsets[u] + v] = min(enclosed[offsets[u] + v], layer)


@njit(cache=True, nogil=True, inline="always")
def _shadow(a, m, slope, low):
    """The tiles, from and to, that any ray is in which meets a brick: by one of their two axes."""
    least = a - max(slope * m, slope * (m + 1)) - low
    most = a + 1 - min(slope * m, slope * (m + 1)) - low
    return int((least - _SLACK) * TILES), int((most + _SLACK) * TILES) + 1


@njit(cache=True, nogil=True, inline="always")
def _covered(u, near):
    """The tiles, from and to, whose rays all stay inside a brick from u to u + 1 at some height."""
    return int(np.ceil((u + near) * TILES)), int((u + 1 - near) * TILES)


@njit(cache=True, nogil=True)
def _pass_cells(slopes, shifts, back, cells, slabs):
    """Fill `cells` and `slabs`, whose bits m, a and b are shifted by `shifts`."""
    one = np.uint64(1)
    for part in range(PARTS**2):
        for m in range(BRICK):
            a, a_end = _passed(part // PARTS, m, slopes[0])
            b, b_end = _passed(part % PARTS, m, slopes[1])
            for x in range(a, a_end):
                for y in range(b, b_end):
                    bit = m << shifts[0] | (x & 3) << shifts[1] | (y & 3) << shifts[2]
                    cells[part, 2 * (x >> 2) + (y >> 2)] |= one << np.uint64(bit)
    for m in range(BRICK):
        for other in range(BRICK**2):
            bit = m << shifts[0] | (other & 3) << shifts[1] | (other >> 2) << shifts[2]
            slabs[BRICK - 1 - m if back else m] |= one << np.uint64(bit)


@njit(cache=True, nogil=True, inline="always")
def _passed(part, m, slope):
    """The cells, from and to, of two bricks' eight that a ray can be in beside the cells m.

    Its smallest coordinate in the layer is in this part of the first brick.
    """
    least = BRICK / PARTS * part + (m if slope > 0 else BRICK - 1 - m) * abs(slope)
    most = least + BRICK / PARTS + abs(slope)
    slack = BRICK * _SLACK
    return max(int(np.floor(least - slack)), 0), min(int(most + slack), 2 * BRICK - 1) + 1

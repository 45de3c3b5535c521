"""Tables of a directional light over a field's bricks.

Shared by all its rays. Bricks are ordered in layers across the light's dominant axis, and rays, by
their position in the first layer, in tiles of half a brick. Each tile has the layers with nonempty
bricks for any of its rays, so that a ray never walks through empty ones; and the layer by which all
of its rays have entered an enclosed brick, behind which nothing is lit. Of a row of tiles only
those from the first to the last with bricks are stored.
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

TILES = 2  # along a brick. With 1 rays visit a third more layers; 4 take four times the memory
PARTS = 16  # of a brick's side, in `LightTables.cells`
NEVER = 255  # in `LightTables.enclosed`: by no layer, or beyond 8 bits
_SLACK = 1e-3  # bricks, for roundings of float32
_LIGHTS = 64  # of `most_bytes`


class LightTables(NamedTuple):
    """Tables of a light along d, in sheared coordinates.

    A ray has constant u = a − slope_a m and v = b − slope_b m. m, a and b are coordinates in bricks
    from the box's corner along `axes`; layers are counted along the ray, from the first with
    bricks; cells as in `FieldBricks`. Tile (i, j) of u and v has number `offsets[i]` + j, if that
    is in [`ends[i]`, `ends[i + 1]`).
    """

    axes: tuple[int, int, int]  # dominant axis of d, and the two others
    slopes: tuple[float, float]  # of the two others, in [−1, 1]
    low: tuple[float, float]  # first u and v of the tiles
    offsets: np.ndarray  # (U,) int32
    ends: np.ndarray  # (U + 1,) int32
    layers: np.ndarray  # (tiles, words) uint64, a bit for each layer with bricks
    enclosed: np.ndarray  # (tiles,) uint8, first layer with an enclosed brick for all rays
    # (PARTS², 4) uint64: cells of 2 × 2 bricks in a layer reached by rays with their smallest a and
    # b in this part of the first brick.
    cells: np.ndarray
    slabs: np.ndarray  # (4,) uint64, the cells of a brick in each quarter of a layer

    @property
    def bytes(self) -> int:
        """Size in memory."""
        return sum(part.nbytes for part in self if isinstance(part, np.ndarray))


def light_tables(bricks: FieldBricks, d: np.ndarray, step: float) -> LightTables:
    """Build a field's tables for rays along d (3,).

    Args:
        step: from sample to sample on a ray, in bricks.
    """
    d = np.asarray(d, np.float64)
    m = int(np.abs(d).argmax())
    axes = m, (m + 1) % 3, (m + 2) % 3
    depth, *across = (bricks.shape[axis] for axis in axes)
    slopes = tuple(float(d[axis] / d[m]) for axis in axes[1:])
    back = bool(d[m] < 0)
    # One more tile on each side, for the slack.
    low = tuple(-max(slope, 0.0) * depth - 1 / TILES for slope in slopes)
    rows, columns = (
        int(np.ceil((side + abs(slope) * depth) * TILES)) + 3 for side, slope in zip(across, slopes)
    )
    coordinates = _brick_coordinates(bricks.nodes, bricks.rows, np.array(axes))
    firsts, lasts = np.full(rows, columns), np.zeros(rows, np.int64)
    _find_spans(coordinates, slopes, low, firsts, lasts)
    ends = np.append(0, np.cumsum(np.maximum(lasts - firsts, 0))).astype(np.int32)
    offsets = (ends[:-1] - firsts).astype(np.int32)
    layers = np.zeros((ends[-1], -(-(depth - 2 * PAD) // 64)), np.uint64)
    enclosed = np.full(ends[-1], NEVER, np.uint8)
    tiles = offsets, ends, layers, enclosed
    _fill_tiles(coordinates, depth, slopes, back, low, step, tiles)
    shifts = np.array([4, 2, 0])[list(axes)]
    cells, slabs = np.zeros((PARTS**2, 4), np.uint64), np.zeros(BRICK, np.uint64)
    _fill_cells(slopes, shifts, back, cells, slabs)
    return LightTables(axes, slopes, low, *tiles, cells, slabs)


def most_bytes(bricks: FieldBricks) -> int:
    """Size of the largest tables of lights all around: the diagonals, and others."""
    diagonals = np.stack(np.unravel_index(np.arange(8), (2, 2, 2)), axis=1) - 0.5
    others = np.random.default_rng(0).normal(size=(_LIGHTS, 3))
    return max(light_tables(bricks, d, 1.0).bytes for d in (*diagonals, *others))


@njit(cache=True, nogil=True)
def _brick_coordinates(nodes, rows, axes):
    """Coordinates m, a, b and enclosed flag of nonempty bricks: (n, 4) int64."""
    coordinates, count = np.empty((len(rows), 4), np.int64), 0
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
                coordinates[count, k] = at[axes[k]]
            coordinates[count, 3] = row == ENCLOSED
            count += 1
    return coordinates[:count]


@njit(cache=True, nogil=True)
def _find_spans(coordinates, slopes, low, firsts, lasts):
    """Find each row's first tile with bricks, and the end."""
    for n in range(len(coordinates)):
        m, a, b = coordinates[n, 0], coordinates[n, 1], coordinates[n, 2]
        i, i_end = _tile_range(a, m, slopes[0], low[0])
        j, j_end = _tile_range(b, m, slopes[1], low[1])
        for u in range(i, i_end):
            firsts[u] = min(firsts[u], j)
            lasts[u] = max(lasts[u], j_end)


@njit(cache=True, nogil=True)
def _fill_tiles(coordinates, depth, slopes, back, low, step, tiles):
    """Enter each brick into the tiles of its rays."""
    offsets, _, layers, enclosed = tiles
    # Largest distance of a sample to any height of a ray.
    near = step / 2 + _SLACK
    for n in range(len(coordinates)):
        m, a, b = coordinates[n, 0], coordinates[n, 1], coordinates[n, 2]
        layer = depth - 1 - PAD - m if back else m - PAD
        word, bit = layer >> 6, np.uint64(1) << np.uint64(layer & 63)
        i, i_end = _tile_range(a, m, slopes[0], low[0])
        j, j_end = _tile_range(b, m, slopes[1], low[1])
        for u in range(i, i_end):
            for v in range(j, j_end):
                layers[offsets[u] + v, word] |= bit
        if coordinates[n, 3] == 0:
            continue
        for height in (m + 0.25, m + 0.75):
            i, i_end = _inner_tile_range(a - slopes[0] * height - low[0], near)
            j, j_end = _inner_tile_range(b - slopes[1] * height - low[1], near)
            for u in range(i, i_end):
                for v in range(j, j_end):
                    enclosed[offsets[u] + v] = min(enclosed[offsets[u] + v], layer)


@njit(cache=True, nogil=True, inline="always")
def _tile_range(a, m, slope, low):
    """Tiles of rays through a brick along an axis: [first, last)."""
    first = a - max(slope * m, slope * (m + 1)) - low
    last = a + 1 - min(slope * m, slope * (m + 1)) - low
    return int((first - _SLACK) * TILES), int((last + _SLACK) * TILES) + 1


@njit(cache=True, nogil=True, inline="always")
def _inner_tile_range(u, near):
    """Tiles of rays all inside [u, u + 1] at some height: [first, last)."""
    return int(np.ceil((u + near) * TILES)), int((u + 1 - near) * TILES)


@njit(cache=True, nogil=True)
def _fill_cells(slopes, shifts, back, cells, slabs):
    """Fill `cells` and `slabs`; `shifts` are those of bits m, a, b."""
    one = np.uint64(1)
    for part in range(PARTS**2):
        for m in range(BRICK):
            a, a_end = _cell_range(part // PARTS, m, slopes[0])
            b, b_end = _cell_range(part % PARTS, m, slopes[1])
            for x in range(a, a_end):
                for y in range(b, b_end):
                    bit = m << shifts[0] | (x & 3) << shifts[1] | (y & 3) << shifts[2]
                    cells[part, 2 * (x >> 2) + (y >> 2)] |= one << np.uint64(bit)
    for m in range(BRICK):
        for other in range(BRICK**2):
            bit = m << shifts[0] | (other & 3) << shifts[1] | (other >> 2) << shifts[2]
            slabs[BRICK - 1 - m if back else m] |= one << np.uint64(bit)


@njit(cache=True, nogil=True, inline="always")
def _cell_range(part, m, slope):
    """Cells of two bricks reached beside cells m: [first, last).

    The rays' smallest coordinate in the layer is in this part of the first brick.
    """
    first = BRICK / PARTS * part + (m if slope > 0 else BRICK - 1 - m) * abs(slope)
    last = first + BRICK / PARTS + abs(slope)
    slack = BRICK * _SLACK
    return max(int(np.floor(first - slack)), 0), min(int(last + slack), 2 * BRICK - 1) + 1

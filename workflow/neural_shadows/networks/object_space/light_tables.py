"""What all rays of one directional light share on their way through a field's bricks.

The bricks are looked at in layers across the axis that the light mostly follows, and where the rays
pass the first layer, in tiles of half a brick. Each tile knows the layers in which any of its rays
can meet a brick that is not empty, so that a ray never walks through empty ones; and by which layer
all of its rays have met an enclosed one, behind which nothing is lit.
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from neural_shadows.networks.object_space.field_bricks import EMPTY, ENCLOSED, PAD
from neural_shadows.networks.object_space.field_marching import BRICK

TILES = 2  # along a brick. With 1 rays look at a third more layers; 4 take four times the memory
PARTS = 16  # of a brick's side, in which `LightTables.cells` tells rays apart
NEVER = 1 << 14  # in `LightTables.enclosed`: a layer that no field has
_SLACK = 1e-3  # bricks, for roundings of float32


class LightTables(NamedTuple):
    """Of a light along d: a ray is at u = a − slope_a m and v = b − slope_b m, wherever it is.

    m, a and b are coordinates in bricks from the box's corner along `axes`; layers are counted
    along the ray, from the first that holds any brick; cells as in `FieldBricks`.
    """

    axes: tuple[int, int, int]  # that d mostly follows, and the two others
    slopes: tuple[float, float]  # of the two others, in [−1, 1]
    low: tuple[float, float]  # u and v where the tiles begin
    layers: np.ndarray  # (U, V, words) uint64, a bit for each layer in which a brick may be met
    enclosed: np.ndarray  # (U, V) int16, the first layer in which an enclosed brick is surely met
    # (PARTS², 4) uint64: the cells of 2 × 2 bricks in a layer that a ray can pass which enters the
    # layer in this part of the first of them, the one with its smallest a and b.
    cells: np.ndarray
    slabs: np.ndarray  # (4,) uint64, the cells of a brick in each quarter of a layer

    @property
    def bytes(self) -> int:
        """In memory."""
        return sum(part.nbytes for part in self if isinstance(part, np.ndarray))


def light_tables(grid: np.ndarray, d: np.ndarray, step: float) -> LightTables:
    """Those of a box of bricks, see `FieldBricks.grid`, for rays along d (3,).

    Args:
        step: from sample to sample on a ray, in bricks.
    """
    d = np.asarray(d, np.float64)
    m = int(np.abs(d).argmax())
    a, b = (m + 1) % 3, (m + 2) % 3
    slopes = d[a] / d[m], d[b] / d[m]
    back = bool(d[m] < 0)
    # A tile more on each side, for the slack.
    low = tuple(-max(slope, 0.0) * grid.shape[m] - 1 / TILES for slope in slopes)
    widths = (grid.shape[axis] + abs(slope) * grid.shape[m] for axis, slope in zip((a, b), slopes))
    tiles = tuple(int(np.ceil(width * TILES)) + 3 for width in widths)
    layers = np.zeros((*tiles, -(-(grid.shape[m] - 2 * PAD) // 64)), np.uint64)
    enclosed = np.full(tiles, NEVER, np.int16)
    _fill(np.moveaxis(grid, (m, a, b), (0, 1, 2)), slopes, back, low, step, layers, enclosed)
    shifts = np.array([4, 2, 0])[[m, a, b]]
    cells, slabs = np.zeros((PARTS**2, 4), np.uint64), np.zeros(BRICK, np.uint64)
    _pass_cells(slopes, shifts, back, cells, slabs)
    return LightTables((m, a, b), slopes, low, layers, enclosed, cells, slabs)


def most_bytes(grid: np.ndarray) -> int:
    """What the tables of no light are larger than: of one along a diagonal, by the longest axis."""
    d = np.where(np.arange(3) == np.argmax(grid.shape), 1.0, 1 - 1e-6)
    return light_tables(grid, d, 1.0).bytes


@njit(cache=True, nogil=True)
def _fill(grid, slopes, back, low, step, layers, enclosed):
    """Enter each brick of a grid (m, a, b) into the tiles whose rays can meet it."""
    depth = len(grid)
    # A sample lies this near to any height of a ray, so that one close to it lies beside it.
    near = step / 2 + _SLACK
    for m in range(PAD, depth - PAD):
        layer = depth - 1 - PAD - m if back else m - PAD
        word, bit = layer >> 6, np.uint64(1) << np.uint64(layer & 63)
        for a in range(grid.shape[1]):
            for b in range(grid.shape[2]):
                if grid[m, a, b] == EMPTY:
                    continue
                i, i_end = _shadow(a, m, slopes[0], low[0])
                j, j_end = _shadow(b, m, slopes[1], low[1])
                for u in range(i, i_end):
                    for v in range(j, j_end):
                        layers[u, v, word] |= bit
                if grid[m, a, b] != ENCLOSED:
                    continue
                for height in (m + 0.25, m + 0.75):
                    i, i_end = _covered(a - slopes[0] * height - low[0], near)
                    j, j_end = _covered(b - slopes[1] * height - low[1], near)
                    for u in range(i, i_end):
                        for v in range(j, j_end):
                            enclosed[u, v] = min(enclosed[u, v], layer)


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

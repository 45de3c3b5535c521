"""Tables of one light over a field's bricks, shared by all of its rays.

The box around the field is cut into slabs one block deep, across the axis that the rays follow
most, and the rays into tiles one block wide, by where they meet the far side of the box. A block is a
cell, or for few rays 2³ or 4³ of them. A tile has the slabs in which any of its rays may pass a cell
that is not all outside, so that a ray never walks through empty ones; and the first slab that all of
its rays pass inside, behind which all is dark. Of a row of tiles only those from the first to the
last with such slabs are stored.

A point light has one table for each side of a cube around it, a directional light one in all.
"""

from typing import NamedTuple

import numpy as np
from numba import njit
from numba.cpython.unsafe.numbers import trailing_zeros

from neural_shadows.representations.distance_bricks.block_rows import (
    WORD,
    gather_blocks,
    project_rows,
    shift_rows,
)
from neural_shadows.representations.distance_bricks.field_bricks import (
    DEEP,
    EMPTY,
    NODE,
    FieldBricks,
)
from neural_shadows.representations.distance_bricks.field_marching import BRICK, FAR
from neural_shadows.representations.distance_bricks.light_projection import (
    CLOSE,
    first_tile,
    last_tile,
    projection,
)

# In `LightTables.ranges`: bits of the first slab, of the number of slabs a bit stands for, and of
# the dark slab.
FIRST, DOUBLED, DARK = 13, 13, 16
NEVER = 0xFFFF  # dark slab: none
_LIGHTS = 64  # of `most_bytes`
_MERGED_BELOW = 0.5, 0.05  # rays for each crossed cell
_ONE = np.uint64(1)


class LightTables(NamedTuple):
    """Tables of the rays that follow one axis most.

    Coordinates are blocks from the box's corner, depths blocks from its side at the light. A ray at
    depth z is at a = u + low_a − slope_a (deep − z), where `deep` is the box's depth; likewise b
    and v. Tile (i, j) holds the rays with i ≤ u < i + 1 and j ≤ v < j + 1. Its number is
    `offsets[i]` + j, if that is in [`ends[i]`, `ends[i + 1]`).
    """

    merged: int  # a block is 2^merged cells wide
    axes: tuple[int, int, int]  # of depth, a and b
    back: bool  # depths run against the first axis
    deep: int  # slabs
    near: bool  # a point light
    # Depth, a and b of a point light; 0 and the slopes of a directional one.
    source: tuple[float, float, float]
    low: tuple[int, int]
    middle: tuple[int, int]  # of u and v, from where they are counted in 2^−20 cells
    offsets: np.ndarray  # (rows,) int32
    ends: np.ndarray  # (rows + 1,) int32
    # (tiles + 1,) uint32: first slab, `DOUBLED` and dark slab of a tile; the last is of no slab
    ranges: np.ndarray
    # (tiles,) uint64: from the first slab on, a bit for each 2^doubled slabs with cells not outside
    slabs: np.ndarray

    @property
    def bytes(self) -> int:
        """Size in memory."""
        return sum(part.nbytes for part in self if isinstance(part, np.ndarray))


def directional_tables(bricks: FieldBricks, to_light: np.ndarray, merged: int = 0) -> LightTables:
    """Build a field's tables for the unit vector to a directional light, (3,)."""
    d = -np.asarray(to_light, np.float64)
    m = int(np.abs(d).argmax())
    axes = m, (m + 1) % 3, (m + 2) % 3
    slopes = tuple(float(d[axis] / abs(d[m])) for axis in axes[1:])
    deep, *across = ((BRICK >> merged) * bricks.shape[axis] for axis in axes)
    low = [min(0.0, slope * deep) for slope in slopes]
    high = [side + max(0.0, slope * deep) for side, slope in zip(across, slopes)]
    return _filled(bricks, merged, axes, bool(d[m] < 0), False, (0.0, *slopes), low, high)


def point_tables(bricks: FieldBricks, position: np.ndarray, merged: int = 0) -> list[LightTables]:
    """Build a field's tables for a point light at (3,), in the cube's [−1, 1]³; none at infinity."""
    light = np.asarray(position, np.float64)
    if not np.isfinite(light).all():
        return []
    # A farther light has the same rays, but its tables' rounded ends have too many tiles: from 10^16
    # on more than memory holds.
    light = light / max(1, np.abs(light).max() / FAR)
    light = (light + 1) * (bricks.size / 2) - bricks.corner  # in bricks
    within = _is_deep(bricks, light)
    light *= BRICK >> merged
    sides = ((m, back) for m in range(3) for back in (False, True))
    tables = (_side(bricks, merged, light, within, m, back) for m, back in sides)
    return [each for each in tables if each is not None and len(each.slabs)]


def _is_deep(bricks: FieldBricks, at: np.ndarray) -> bool:
    """Test for a deep brick at a position (3,) in bricks from the box's corner."""
    if not ((at >= 0) & (at < bricks.shape)).all():
        return False
    x, y, z = at.astype(int)
    node = bricks.nodes[x // NODE, y // NODE, z // NODE]
    return bool(bricks.rows[node + 16 * (x % NODE) + NODE * (y % NODE) + z % NODE] == DEEP)


def _side(
    bricks: FieldBricks, merged: int, light: np.ndarray, within: bool, m: int, back: bool
) -> LightTables | None:
    """Tables of rays from a point light along one axis; None if the box is not there.

    Args:
        light: its position in blocks from the box's corner. within: a deep brick.
    """
    axes = m, (m + 1) % 3, (m + 2) % 3
    deep, *across = ((BRICK >> merged) * bricks.shape[axis] for axis in axes)
    z = deep - light[m] if back else light[m]
    reach = deep - z  # from the light to the far side
    if reach <= 0:
        return None
    # The box as the light casts it on its far side, within 45 degrees.
    grown = reach / max(-z, CLOSE)
    low, high = [], []
    for axis, side in zip(axes[1:], across):
        x = light[axis]
        low.append(max(min(0.0, x - x * grown), x - reach))
        high.append(min(max(side, x + (side - x) * grown), x + reach))
        if low[-1] >= high[-1]:
            return None
    source = float(z), float(light[axes[1]]), float(light[axes[2]])
    return _filled(bricks, merged, axes, back, True, source, low, high, within)


def _filled(bricks, merged, axes, back, near, source, low, high, within=False) -> LightTables:
    """Tables of the rays that meet the far side from `low` to `high`.

    Args:
        within: the light is, so that rays meet deep bricks first.
    """
    # One more tile on each side, for the slack.
    low = tuple(int(np.floor(each)) - 1 for each in low)
    rows, columns = (int(np.ceil(end)) + 1 - start for start, end in zip(low, high))
    deep, *sides = ((BRICK >> merged) * bricks.shape[axis] for axis in axes)
    coordinates, layers = _by_layers(bricks, merged, axes, back, EMPTY if within else DEEP)
    firsts, lasts = np.full(rows, columns), np.zeros(rows, np.int64)
    light = deep, near, source, low
    _find_spans(coordinates, layers, merged, light, sides[0], firsts, lasts, columns)
    ends = np.append(0, np.cumsum(np.maximum(lasts - firsts, 0))).astype(np.int32)
    offsets = (ends[:-1] - firsts).astype(np.int32)
    ranges = np.full(ends[-1] + 1, (1 << FIRST) - 1 | NEVER << DARK, np.uint32)
    slabs = np.zeros(ends[-1], np.uint64)
    masks = bricks.masks, bricks.sheet, merged, axes[0], back
    _fill_tiles(coordinates, layers, masks, light, tuple(sides), columns, offsets, ranges, slabs)
    middle = rows // 2, columns // 2
    tiles = offsets, ends, ranges, slabs
    return LightTables(merged, axes, back, deep, near, source, low, middle, *tiles)


def merging(rays: int, bricks: FieldBricks) -> int:
    """`merged` of tables for so many rays: small blocks take time, and save samples.

    Of the Stanford dragon at 256³ tables of single cells take 2.4 ms, of 2³ 0.8 and of 4³ 0.4; a ray
    then takes 15 and 50 ns more in C, 8 and 25 in Numba.
    """
    return sum(rays < share * len(bricks.words) for share in _MERGED_BELOW)


def most_bytes(bricks: FieldBricks) -> int:
    """Size of the largest tables of directional lights: the diagonals, and others."""
    diagonals = np.stack(np.unravel_index(np.arange(8), (2, 2, 2)), axis=1) - 0.5
    others = np.random.default_rng(0).normal(size=(_LIGHTS, 3))
    return max(directional_tables(bricks, d).bytes for d in (*diagonals, *others))


@njit(cache=True, nogil=True)
def _by_layers(bricks, merged, axes, back, left_out):
    """Sort bricks by layers across an axis, from the light on, without empty and other ones.

    Returns (n, 3) int32: blocks a and b of their corners, and rows; and (layers + 1,) int64: each
    layer's first brick.
    """
    nodes, rows = bricks.nodes, bricks.rows
    count = bricks.shape[axes[0]]
    layers = np.zeros(count + 1, np.int64)
    unsorted, total = np.empty((len(rows), 4), np.int32), 0
    at = np.empty(3, np.int64)
    for x, y, z in np.ndindex(nodes.shape):
        if nodes[x, y, z] == 0:
            continue
        for inner in range(NODE**3):
            row = rows[nodes[x, y, z] + inner]
            if row == EMPTY or row == left_out:
                continue
            at[0] = x * NODE + (inner >> 4)
            at[1] = y * NODE + (inner >> 2 & 3)
            at[2] = z * NODE + (inner & 3)
            layer = count - 1 - at[axes[0]] if back else at[axes[0]]
            unsorted[total, 0] = layer
            unsorted[total, 1] = (BRICK >> merged) * at[axes[1]]
            unsorted[total, 2] = (BRICK >> merged) * at[axes[2]]
            unsorted[total, 3] = row
            layers[layer + 1] += 1
            total += 1
    layers = np.cumsum(layers)
    following = layers.copy()
    coordinates = np.empty((total, 3), np.int32)
    for n in range(total):
        to = following[unsorted[n, 0]]
        following[unsorted[n, 0]] += 1
        for column in range(3):
            coordinates[to, column] = unsorted[n, 1 + column]
    return coordinates, layers


@njit(cache=True, nogil=True)
def _find_spans(coordinates, layers, merged, light, side, firsts, lasts, columns):
    """Find each row's first tile with bricks, and the end."""
    rows, brick = len(firsts), BRICK >> merged
    low, high = np.empty(side // brick, np.int64), np.empty(side // brick, np.int64)
    for layer in range(len(layers) - 1):
        seen, to_a, to_b = projection(brick * layer, brick * (layer + 1), light)
        if not seen:
            continue
        low[:], high[:] = np.iinfo(np.int64).max, -1
        for n in range(layers[layer], layers[layer + 1]):
            k, b = coordinates[n, 0] // brick, coordinates[n, 1]
            low[k], high[k] = min(low[k], b), max(high[k], b)
        for k in range(len(low)):
            if high[k] < 0:
                continue
            a = brick * k
            j, j_end = first_tile(low[k], to_b), last_tile(high[k] + brick - 1, to_b) + 1
            j, j_end = max(j, 0), min(j_end, columns)
            if j < j_end:
                i_end = min(last_tile(a + brick - 1, to_a) + 1, rows)
                for i in range(max(first_tile(a, to_a), 0), i_end):
                    firsts[i], lasts[i] = min(firsts[i], j), max(lasts[i], j_end)


@njit(cache=True, nogil=True, error_model="numpy")
def _fill_tiles(coordinates, layers, masks, light, sides, columns, offsets, ranges, slabs):
    """Enter each slab into the tiles of its rays."""
    masks, sheet, merged, m, back = masks
    brick = BRICK >> merged
    rows, width, words = len(offsets), (sides[1] + WORD - 1) // WORD, columns // WORD + 1
    any_in, all_in = np.zeros((2, brick * sides[0] * width), np.uint64)
    passing, within = np.zeros((2, sides[0] * words), np.uint64)
    spans = np.zeros((sides[0], 3), np.int32)
    seen, dark = np.zeros((2, rows * words), np.uint64)  # tiles with slabs, with a dark one
    for layer in range(len(layers) - 1):
        start, end = layers[layer], layers[layer + 1]
        if start == end:
            continue
        a_first, a_end = gather_blocks(
            coordinates, start, end, masks, sheet, merged, m, sides[0], width, any_in, all_in
        )
        for inner in range(brick):
            slab = brick * layer + inner
            behind, to_a, to_b = projection(slab, slab + 1, light)
            if not behind:
                continue
            low, high = a_first, a_end
            while low < high and last_tile(low, to_a) < 0:
                low += 1
            while low < high and first_tile(high - 1, to_a) >= rows:
                high -= 1
            part = (brick - 1 - inner if back else inner) * sides[0]
            of_slab = low, high, part, width, words, columns
            if light[1]:
                project_rows(of_slab, any_in, all_in, to_b, passing, within, spans)
            else:
                shift_rows(of_slab, any_in, all_in, to_b, passing, within, spans)
            whole = not light[1] or slab >= light[2][0]  # all of the slab is behind the light
            of_slab = slab, whole, low, high, to_a, words
            _enter_slab(of_slab, passing, within, spans, seen, dark, offsets, ranges, slabs)


@njit(cache=True, nogil=True, error_model="numpy")
def _enter_slab(of_slab, passing, within, spans, seen, dark, offsets, ranges, slabs):
    """Enter a slab into its tiles.

    Args:
        passing, within, spans: of each row of cells, see `shift_rows`.
    """
    slab, whole, a_first, a_end, to, words = of_slab
    low, high = a_first, a_first  # rows of cells that a row of tiles passes: [low, high)
    i_end = min(last_tile(a_end - 1, to) + 1, len(offsets))
    for i in range(max(first_tile(a_first, to), 0), i_end):
        while low < a_end and last_tile(low, to) < i:
            low += 1
        while high < a_end and first_tile(high, to) <= i:
            high += 1
        first, end = words, 0
        inside = whole and last_tile(a_first - 1, to) < i and first_tile(a_end, to) > i
        for a in range(low, high):
            first, end = min(first, spans[a, 0]), max(end, spans[a, 1])
            inside = inside and spans[a, 2] != 0
        for k in range(first, end):
            tiles, at = np.uint64(0), i * words + k
            for a in range(low, high):
                tiles |= passing[a * words + k]
            tiles &= ~dark[at]
            if tiles == 0:
                continue
            base = offsets[i] + WORD * k
            _add_slab(slab, base, tiles & ~seen[at], tiles & seen[at], ranges, slabs)
            seen[at] |= tiles
            if inside:
                for a in range(low, high):
                    tiles &= within[a * words + k]
                dark[at] |= tiles
                while tiles:
                    tile = base + np.int64(trailing_zeros(tiles))
                    tiles &= tiles - _ONE
                    ranges[tile] = ranges[tile] & np.uint32(NEVER) | np.uint32(slab << DARK)


@njit(cache=True, nogil=True)
def _add_slab(slab, base, new, old, ranges, slabs):
    """Set a slab's bit in tiles, as bits from tile `base` on, without and with earlier slabs."""
    while new:
        tile = base + np.int64(trailing_zeros(new))
        new &= new - _ONE
        ranges[tile] = slab | NEVER << DARK
        slabs[tile] = _ONE
    while old:
        tile = base + np.int64(trailing_zeros(old))
        old &= old - _ONE
        after = slab - np.int64(ranges[tile] & np.uint32((1 << FIRST) - 1))
        doubled = np.int64(ranges[tile] >> np.uint32(DOUBLED) & np.uint32(7))
        while after >> doubled >= WORD:  # a bit then stands for twice as many slabs
            slabs[tile] = _halved(slabs[tile])
            ranges[tile] += np.uint32(1 << DOUBLED)
            doubled += 1
        slabs[tile] |= _ONE << np.uint64(after >> doubled)


@njit(cache=True, nogil=True)
def _halved(bits):
    """Half as many bits, each set if any of two is."""
    bits = (bits | bits >> _ONE) & np.uint64(0x5555555555555555)
    bits = (bits | bits >> np.uint64(1)) & np.uint64(0x3333333333333333)
    bits = (bits | bits >> np.uint64(2)) & np.uint64(0x0F0F0F0F0F0F0F0F)
    bits = (bits | bits >> np.uint64(4)) & np.uint64(0x00FF00FF00FF00FF)
    bits = (bits | bits >> np.uint64(8)) & np.uint64(0x0000FFFF0000FFFF)
    return (bits | bits >> np.uint64(16)) & np.uint64(0x00000000FFFFFFFF)

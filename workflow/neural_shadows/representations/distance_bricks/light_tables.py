"""Tables of one light over a field's bricks, shared by all of its rays.

The box around the field is cut into slabs one cell deep, across the axis that the rays follow most,
and the rays into tiles one cell wide, by where they meet the far side of the box. A tile has the
slabs in which any of its rays may pass a cell that is not all outside, so that a ray never walks
through empty ones; and the first slab that all of its rays pass inside, behind which all is dark.
Of a row of tiles only those from the first to the last with such slabs are stored.

A point light has one table for each side of a cube around it, a directional light one in all.
"""

from typing import NamedTuple

import numpy as np
from numba import njit
from numba.cpython.unsafe.numbers import trailing_zeros

from neural_shadows.representations.distance_bricks.field_bricks import EMPTY, NODE, FieldBricks
from neural_shadows.representations.distance_bricks.field_marching import BRICK

# In `LightTables.ranges`: bits of the first slab, of the number of slabs a bit stands for, and of
# the dark slab.
FIRST, MERGED, DARK = 13, 13, 16
NEVER = 0xFFFF  # dark slab: none
_WORD = 64
_SLACK = 4e-3  # cells, for a ray's rounding to 2^−20 cells a step
_CLOSE = 1e-3  # cells; nearer to a point light its rays spread over all tiles
_LIGHTS = 64  # of `most_bytes`
_ONE = np.uint64(1)
_ALL = ~np.uint64(0)


class LightTables(NamedTuple):
    """Tables of the rays that follow one axis most.

    Coordinates are cells from the box's corner, depths cells from its side at the light. A ray at
    depth z is at a = u + low_a − slope_a (deep − z), where `deep` is the box's depth; likewise b
    and v. Tile (i, j) holds the rays with i ≤ u < i + 1 and j ≤ v < j + 1. Its number is
    `offsets[i]` + j, if that is in [`ends[i]`, `ends[i + 1]`).
    """

    axes: tuple[int, int, int]  # of depth, a and b
    back: bool  # depths run against the first axis
    deep: int  # slabs
    near: bool  # a point light
    # Depth, a and b of a point light; 0 and the slopes of a directional one.
    source: tuple[float, float, float]
    low: tuple[int, int]
    offsets: np.ndarray  # (rows,) int32
    ends: np.ndarray  # (rows + 1,) int32
    # (tiles + 1,) uint32: first slab, `MERGED` and dark slab of a tile; the last is of no slab
    ranges: np.ndarray
    # (tiles,) uint64: from the first slab on, a bit for each 2^merged slabs with cells not outside
    slabs: np.ndarray

    @property
    def bytes(self) -> int:
        """Size in memory."""
        return sum(part.nbytes for part in self if isinstance(part, np.ndarray))


def directional_tables(bricks: FieldBricks, to_light: np.ndarray) -> LightTables:
    """Build a field's tables for the unit vector to a directional light, (3,)."""
    d = -np.asarray(to_light, np.float64)
    m = int(np.abs(d).argmax())
    axes = m, (m + 1) % 3, (m + 2) % 3
    slopes = tuple(float(d[axis] / abs(d[m])) for axis in axes[1:])
    deep, *across = (BRICK * bricks.shape[axis] for axis in axes)
    low = [min(0.0, slope * deep) for slope in slopes]
    high = [side + max(0.0, slope * deep) for side, slope in zip(across, slopes)]
    return _filled(bricks, axes, bool(d[m] < 0), False, (0.0, *slopes), low, high)


def point_tables(bricks: FieldBricks, position: np.ndarray) -> list[LightTables]:
    """Build a field's tables for a point light at (3,), in the cube's [−1, 1]³."""
    light = np.asarray(position, np.float64)
    light = BRICK * ((light + 1) * (bricks.size / 2) - bricks.corner)
    sides = ((m, back) for m in range(3) for back in (False, True))
    tables = (_side(bricks, light, m, back) for m, back in sides)
    return [each for each in tables if each is not None and len(each.slabs)]


def _side(bricks: FieldBricks, light: np.ndarray, m: int, back: bool) -> LightTables | None:
    """Tables of rays from a point light along one axis; None if the box is not there.

    Args:
        light: its position in cells from the box's corner.
    """
    axes = m, (m + 1) % 3, (m + 2) % 3
    deep, *across = (BRICK * bricks.shape[axis] for axis in axes)
    z = deep - light[m] if back else light[m]
    reach = deep - z  # from the light to the far side
    if reach <= 0:
        return None
    # The box as the light casts it on its far side, within 45 degrees.
    grown = reach / max(-z, _CLOSE)
    low, high = [], []
    for axis, side in zip(axes[1:], across):
        x = light[axis]
        low.append(max(min(0.0, x - x * grown), x - reach))
        high.append(min(max(side, x + (side - x) * grown), x + reach))
        if low[-1] >= high[-1]:
            return None
    source = float(z), float(light[axes[1]]), float(light[axes[2]])
    return _filled(bricks, axes, back, True, source, low, high)


def _filled(bricks, axes, back, near, source, low, high) -> LightTables:
    """Tables of the rays that meet the far side from `low` to `high`."""
    # One more tile on each side, for the slack.
    low = tuple(int(np.floor(each)) - 1 for each in low)
    rows, columns = (int(np.ceil(end)) + 1 - start for start, end in zip(low, high))
    deep = BRICK * bricks.shape[axes[0]]
    coordinates, layers = _by_layers(bricks, axes, back)
    sides = BRICK * bricks.shape[axes[1]], BRICK * bricks.shape[axes[2]]
    firsts, lasts = np.full(rows, columns), np.zeros(rows, np.int64)
    light = deep, near, source, low
    _find_spans(coordinates, layers, light, sides[0], firsts, lasts, columns)
    ends = np.append(0, np.cumsum(np.maximum(lasts - firsts, 0))).astype(np.int32)
    offsets = (ends[:-1] - firsts).astype(np.int32)
    ranges = np.full(ends[-1] + 1, (1 << FIRST) - 1 | NEVER << DARK, np.uint32)
    slabs = np.zeros(ends[-1], np.uint64)
    masks = bricks.masks, bricks.sheet, axes[0], back
    _fill_tiles(coordinates, layers, masks, light, sides, columns, offsets, ranges, slabs)
    return LightTables(axes, back, deep, near, source, low, offsets, ends, ranges, slabs)


def most_bytes(bricks: FieldBricks) -> int:
    """Size of the largest tables of directional lights: the diagonals, and others."""
    diagonals = np.stack(np.unravel_index(np.arange(8), (2, 2, 2)), axis=1) - 0.5
    others = np.random.default_rng(0).normal(size=(_LIGHTS, 3))
    return max(directional_tables(bricks, d).bytes for d in (*diagonals, *others))


@njit(cache=True, nogil=True)
def _by_layers(bricks, axes, back):
    """Sort nonempty bricks by layers across an axis, from the light on.

    Returns (n, 3) int32: cells a and b of their corners, and rows; and (layers + 1,) int64: each
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
            if row == EMPTY:
                continue
            at[0] = x * NODE + (inner >> 4)
            at[1] = y * NODE + (inner >> 2 & 3)
            at[2] = z * NODE + (inner & 3)
            layer = count - 1 - at[axes[0]] if back else at[axes[0]]
            unsorted[total, 0] = layer
            unsorted[total, 1], unsorted[total, 2] = BRICK * at[axes[1]], BRICK * at[axes[2]]
            unsorted[total, 3] = row
            layers[layer + 1] += 1
            total += 1
    layers = np.cumsum(layers)
    following = layers.copy()
    coordinates = np.empty((total, 3), np.int32)
    for n in range(total):
        to = following[unsorted[n, 0]]
        following[unsorted[n, 0]] += 1
        coordinates[to] = unsorted[n, 1:]
    return coordinates, layers


@njit(cache=True, nogil=True)
def _find_spans(coordinates, layers, light, side, firsts, lasts, columns):
    """Find each row's first tile with bricks, and the end."""
    rows = len(firsts)
    low, high = np.empty(side // BRICK, np.int64), np.empty(side // BRICK, np.int64)
    for layer in range(len(layers) - 1):
        seen, to_a, to_b = _projection(BRICK * layer, BRICK * (layer + 1), light)
        if not seen:
            continue
        low[:], high[:] = np.iinfo(np.int64).max, -1
        for n in range(layers[layer], layers[layer + 1]):
            k, b = coordinates[n, 0] // BRICK, coordinates[n, 1]
            low[k], high[k] = min(low[k], b), max(high[k], b)
        for k in range(len(low)):
            if high[k] < 0:
                continue
            a = BRICK * k
            j, j_end = _first_tile(low[k], to_b), _last_tile(high[k] + BRICK - 1, to_b) + 1
            j, j_end = max(j, 0), min(j_end, columns)
            if j < j_end:
                i_end = min(_last_tile(a + BRICK - 1, to_a) + 1, rows)
                for i in range(max(_first_tile(a, to_a), 0), i_end):
                    firsts[i], lasts[i] = min(firsts[i], j), max(lasts[i], j_end)


@njit(cache=True, nogil=True, inline="always")
def _projection(start, end, light):
    """How cells from depth `start` to `end` are cast on the tiles.

    Whether they lie behind the light, and for a and b a factor and a shift at both depths.
    """
    deep, near, source, low = light
    if near:
        if end <= source[0]:
            return False, (0.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0)
        reach = deep - source[0]
        f, g = reach / max(start - source[0], _CLOSE), reach / (end - source[0])
        a, b = source[1], source[2]
        return (
            True,
            (f, a - a * f - low[0], g, a - a * g - low[0]),
            (f, b - b * f - low[1], g, b - b * g - low[1]),
        )
    ahead, behind = float(deep - start), float(deep - end)
    return (
        True,
        (1.0, source[1] * ahead - low[0], 1.0, source[1] * behind - low[0]),
        (1.0, source[2] * ahead - low[1], 1.0, source[2] * behind - low[1]),
    )


@njit(cache=True, nogil=True, inline="always")
def _first_tile(cell, to):
    """First tile of rays through a cell."""
    return np.int64(np.floor(min(cell * to[0] + to[1], cell * to[2] + to[3]) - _SLACK))


@njit(cache=True, nogil=True, inline="always")
def _last_tile(cell, to):
    """Last tile of rays through a cell."""
    return np.int64(np.floor(max((cell + 1) * to[0] + to[1], (cell + 1) * to[2] + to[3]) + _SLACK))


@njit(cache=True, nogil=True, error_model="numpy")
def _fill_tiles(coordinates, layers, masks, light, sides, columns, offsets, ranges, slabs):
    """Enter each slab into the tiles of its rays.

    Rows of bits are flat arrays of words: of cells `width` a row, of tiles `words`.
    """
    masks, sheet, m, back = masks
    rows, width, words = len(offsets), (sides[1] + _WORD - 1) // _WORD, columns // _WORD + 1
    # Cells of four slabs: any corner, and all corners inside.
    any_in = np.zeros(BRICK * sides[0] * width, np.uint64)
    all_in = np.zeros(BRICK * sides[0] * width, np.uint64)
    # By rows of cells, the tiles that any, and that all rays of which pass such cells.
    passing = np.zeros(sides[0] * words, np.uint64)
    within = np.zeros(sides[0] * words, np.uint64)
    spans = np.zeros((sides[0], 3), np.int32)
    seen, dark = np.zeros(rows * words, np.uint64), np.zeros(rows * words, np.uint64)
    for layer in range(len(layers) - 1):
        start, end = layers[layer], layers[layer + 1]
        if start == end:
            continue
        a_first, a_end = _gather_cells(
            coordinates, start, end, masks, sheet, m, sides[0], width, any_in, all_in
        )
        for inner in range(BRICK):
            slab = BRICK * layer + inner
            behind, to_a, to_b = _projection(slab, slab + 1, light)
            if not behind:
                continue
            whole = not light[1] or slab >= light[2][0]  # all of the slab is behind the light
            part = (BRICK - 1 - inner if back else inner) * sides[0]
            a_low, a_high = a_first, a_end
            while a_low < a_high and _last_tile(a_low, to_a) < 0:
                a_low += 1
            while a_low < a_high and _first_tile(a_high - 1, to_a) >= rows:
                a_high -= 1
            rows_of = a_low, a_high, part, width, words, columns
            if light[1]:
                _cast_rows(rows_of, any_in, all_in, to_b, passing, within, spans)
            else:
                _shift_rows(rows_of, any_in, all_in, to_b, passing, within, spans)
            _enter_slab(
                slab, whole, a_low, a_high, to_a, words, passing, within, spans, seen, dark,
                offsets, ranges, slabs,
            )  # fmt: skip


@njit(cache=True, nogil=True, error_model="numpy")
def _gather_cells(coordinates, start, end, masks, sheet, m, side, width, any_in, all_in):
    """Fill the cells of a layer of bricks; return the first a and the end."""
    a_first, a_end = np.int64(side), np.int64(0)
    for n in range(start, end):
        a_first = min(a_first, coordinates[n, 0])
        a_end = max(a_end, coordinates[n, 0] + BRICK)
    for part in range(BRICK):
        for k in range((part * side + a_first) * width, (part * side + a_end) * width):
            any_in[k] = all_in[k] = 0
    for n in range(start, end):
        a, b, row = coordinates[n, 0], coordinates[n, 1], coordinates[n, 2]
        some, every = masks[row, 0], masks[row, 1]
        if sheet:  # only crossed cells matter, and no slab hides all behind it
            some, every = some & ~every, np.uint64(0)
        some, every = _turned(some, m), _turned(every, m)
        word, shift = a * width + (b >> 6), np.uint64(b & 63)
        for part in range(BRICK):
            for x in range(BRICK):
                bits, to = np.uint64(16 * part + 4 * x), (part * side + x) * width + word
                any_in[to] |= (some >> bits & np.uint64(15)) << shift
                all_in[to] |= (every >> bits & np.uint64(15)) << shift
    return a_first, a_end


def _swap(*fields: int) -> list[tuple[np.uint64, np.uint64]]:
    """Masks and shifts that swap two fields of two bits in the numbers of a mask's bits."""
    numbers = np.arange(BRICK**3)
    swaps = []
    for low, high in zip(range(fields[0], fields[0] + 2), range(fields[1], fields[1] + 2)):
        moved = numbers[(numbers >> low & 1 == 1) & (numbers >> high & 1 == 0)]
        mask = np.bitwise_or.reduce(np.uint64(1) << moved.astype(np.uint64))
        swaps.append((mask, np.uint64((1 << high) - (1 << low))))
    return swaps


# Bit 16 x + 4 y + z to 16 y + 4 z + x, and to 16 z + 4 x + y.
_TURNS = np.array([_swap(2, 4) + _swap(0, 2), _swap(0, 2) + _swap(2, 4)])


@njit(cache=True, nogil=True, inline="always")
def _turned(mask, m):
    """A brick's mask with depth as its first axis, a and b as the others."""
    if m > 0:
        for k in range(4):
            moved, shift = _TURNS[m - 1, k, 0], _TURNS[m - 1, k, 1]
            swapped = (mask >> shift ^ mask) & moved
            mask ^= swapped ^ swapped << shift
    return mask


@njit(cache=True, nogil=True, error_model="numpy")
def _cast_rows(rows, any_in, all_in, to, passing, within, spans):
    """Cast rows of cells on tiles: fill `passing`, `within` and `spans`, see `_enter_slab`."""
    a_first, a_end, part, width, words, columns = rows
    for a in range(a_first, a_end):
        cells, tiles = (part + a) * width, a * words
        for k in range(tiles, tiles + words):
            passing[k] = within[k] = 0
        first, end = _cast_any(any_in, cells, width, to, columns, passing, tiles)
        spans[a, 0], spans[a, 1] = first, end
        spans[a, 2] = first < end and _cast_all(all_in, cells, width, to, columns, within, tiles)


@njit(cache=True, nogil=True, error_model="numpy")
def _shift_rows(rows, any_in, all_in, to, passing, within, spans):
    """`_cast_rows` on tiles as wide as cells, by words."""
    a_first, a_end, part, width, words, _ = rows
    offset, last = _first_tile(0, to), _last_tile(0, to)
    beside, skipped, up = last - offset, offset >> 6, np.uint64(offset & 63)
    down, none = np.uint64(63) - up, np.uint64(0)
    for a in range(a_first, a_end):
        cells, tiles = (part + a) * width, a * words
        for k in range(tiles, tiles + words):
            passing[k] = within[k] = 0
        first, end, inside = words, 0, none
        some_before = every_before = any_before = all_before = none
        for k in range(width + 2):
            some = any_in[cells + k] if k < width else none
            every = all_in[cells + k] if k < width else none
            any_here, all_here = some, every
            for c in range(1, beside + 1):
                left, right = np.uint64(c), np.uint64(64 - c)
                any_here |= some << left | some_before >> right
                all_here &= every << left | every_before >> right
            some_before, every_before = some, every
            word = any_here << up | any_before >> down >> _ONE
            if word:
                passing[tiles + skipped + k] = word
                first, end = min(first, skipped + k), skipped + k + 1
                word = all_here << up | all_before >> down >> _ONE
                within[tiles + skipped + k] = word
                inside |= word
            any_before, all_before = any_here, all_here
        spans[a, 0], spans[a, 1], spans[a, 2] = first, end, inside != 0


@njit(cache=True, nogil=True, error_model="numpy")
def _cast_any(cells, at, width, to, columns, tiles, base):
    """Set tiles with rays through any of a row's cells; return the first word and the end."""
    first, end = columns, 0
    start, stop = _next_run(cells, at, width, 0)
    while start < stop:
        j, j_last = max(_first_tile(start, to), 0), min(_last_tile(stop - 1, to), columns - 1)
        if j <= j_last:
            _set_bits(tiles, base, j, j_last)
            first, end = min(first, j >> 6), (j_last >> 6) + 1
        start, stop = _next_run(cells, at, width, stop)
    return first, end


@njit(cache=True, nogil=True, error_model="numpy")
def _cast_all(cells, at, width, to, columns, tiles, base):
    """Set tiles all rays of which pass a row's cells; return whether there are any."""
    some = False
    start, stop = _next_run(cells, at, width, 0)
    while start < stop:
        j, j_last = max(_last_tile(start - 1, to) + 1, 0), min(_first_tile(stop, to), columns) - 1
        if j <= j_last:
            _set_bits(tiles, base, j, j_last)
            some = True
        start, stop = _next_run(cells, at, width, stop)
    return some


@njit(cache=True, nogil=True, inline="always")
def _next_run(cells, at, width, bit):
    """Next run of set bits of a row at or after a bit: [start, stop), empty at the end."""
    k, end = bit >> 6, _WORD * width
    if k >= width:
        return end, end
    word = cells[at + k] & _ALL << np.uint64(bit & 63)
    while word == 0:
        k += 1
        if k == width:
            return end, end
        word = cells[at + k]
    start = np.int64(trailing_zeros(word))
    word = ~(word | (_ONE << np.uint64(start)) - _ONE)
    start += _WORD * k
    while word == 0:
        k += 1
        if k == width:
            return start, end
        word = ~cells[at + k]
    return start, np.int64(trailing_zeros(word)) + _WORD * k


@njit(cache=True, nogil=True, inline="always")
def _set_bits(words, base, first, last):
    """Set a row's bits from `first` to `last`."""
    start, end = _ALL << np.uint64(first & 63), _ALL >> np.uint64(63 - (last & 63))
    k, k_last = base + (first >> 6), base + (last >> 6)
    if k == k_last:
        words[k] |= start & end
        return
    words[k] |= start
    for between in range(k + 1, k_last):
        words[between] = _ALL
    words[k_last] |= end


@njit(cache=True, nogil=True, error_model="numpy")
def _enter_slab(
    slab,
    whole,
    a_first,
    a_end,
    to,
    words,
    passing,
    within,
    spans,
    seen,
    dark,
    offsets,
    ranges,
    slabs,
):
    """Enter a slab into its tiles.

    Args:
        passing, within: of each row of cells, see `_fill_tiles`. spans: the words of `passing`
            that are not 0, [first, end), and whether `within` is anywhere.
    """
    low, high = a_first, a_first  # rows of cells that a row of tiles passes: [low, high)
    i_end = min(_last_tile(a_end - 1, to) + 1, len(offsets))
    for i in range(max(_first_tile(a_first, to), 0), i_end):
        while low < a_end and _last_tile(low, to) < i:
            low += 1
        while high < a_end and _first_tile(high, to) <= i:
            high += 1
        first, end = words, 0
        inside = whole and _last_tile(a_first - 1, to) < i and _first_tile(a_end, to) > i
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
            base = offsets[i] + _WORD * k
            new, old = tiles & ~seen[at], tiles & seen[at]
            seen[at] |= new
            while new:
                tile = base + np.int64(trailing_zeros(new))
                new &= new - _ONE
                ranges[tile] = slab | NEVER << DARK
                slabs[tile] = _ONE
            while old:
                tile = base + np.int64(trailing_zeros(old))
                old &= old - _ONE
                _add_slab(tile, slab, ranges, slabs)
            if inside:
                for a in range(low, high):
                    tiles &= within[a * words + k]
                dark[at] |= tiles
                while tiles:
                    tile = base + np.int64(trailing_zeros(tiles))
                    tiles &= tiles - _ONE
                    ranges[tile] = ranges[tile] & np.uint32(NEVER) | np.uint32(slab << DARK)


@njit(cache=True, nogil=True, inline="always")
def _add_slab(tile, slab, ranges, slabs):
    """Set a later slab's bit; where they do not suffice, one stands for twice as many."""
    after = slab - np.int64(ranges[tile] & np.uint32((1 << FIRST) - 1))
    merged = np.int64(ranges[tile] >> np.uint32(MERGED) & np.uint32(7))
    while after >> merged >= _WORD:
        slabs[tile] = _halved(slabs[tile])
        ranges[tile] += np.uint32(1 << MERGED)
        merged += 1
    slabs[tile] |= _ONE << np.uint64(after >> merged)


@njit(cache=True, nogil=True)
def _halved(bits):
    """Half as many bits, each set if any of two is."""
    bits = (bits | bits >> _ONE) & np.uint64(0x5555555555555555)
    bits = (bits | bits >> np.uint64(1)) & np.uint64(0x3333333333333333)
    bits = (bits | bits >> np.uint64(2)) & np.uint64(0x0F0F0F0F0F0F0F0F)
    bits = (bits | bits >> np.uint64(4)) & np.uint64(0x00FF00FF00FF00FF)
    bits = (bits | bits >> np.uint64(8)) & np.uint64(0x0000FFFF0000FFFF)
    return (bits | bits >> np.uint64(16)) & np.uint64(0x00000000FFFFFFFF)

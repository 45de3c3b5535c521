"""Rows of blocks of cells as bits, and the tiles of a light's rays that pass them.

Flat arrays of 64-bit words: `width` words a row of blocks, `words` a row of tiles.
"""

import numpy as np
from numba import njit
from numba.cpython.unsafe.numbers import trailing_zeros

from neural_shadows.representations.distance_bricks.field_marching import BRICK
from neural_shadows.representations.distance_bricks.light_projection import first_tile, last_tile

WORD = 64  # bits
_ONE = np.uint64(1)
_ALL = ~np.uint64(0)


@njit(cache=True, nogil=True, error_model="numpy")
def gather_blocks(coordinates, start, end, masks, sheet, merged, m, side, width, any_in, all_in):
    """Fill the blocks of a layer of bricks; return the first a and the end.

    Args:
        coordinates: (n, 3), a, b and rows of bricks, of which those from `start` to `end` count.
        masks: of `FieldBricks`. m: the axis of depth. side: blocks along a.
        any_in, all_in: (slabs side width,) of a layer's slabs, with any and with all corners
            inside; of a sheet with crossed cells, and none.
    """
    a_first, a_end, brick = np.int64(side), np.int64(0), BRICK >> merged
    for n in range(start, end):
        a_first = min(a_first, coordinates[n, 0])
        a_end = max(a_end, coordinates[n, 0] + brick)
    for part in range(brick):
        for k in range((part * side + a_first) * width, (part * side + a_end) * width):
            any_in[k] = all_in[k] = 0
    for n in range(start, end):
        a, b, row = coordinates[n, 0], coordinates[n, 1], coordinates[n, 2]
        some, every = masks[row, 0], masks[row, 1]
        if sheet:
            some, every = some & ~every, np.uint64(0)
        some, every = _turned(some, m), _turned(every, m)
        for level in range(merged):
            for along in (1, 4, 16):
                shift = np.uint64(along << level)
                some, every = some | some >> shift, every & every >> shift
        word, shift = a * width + (b >> 6), np.uint64(b & 63)
        for part in range(brick):
            for x in range(brick):
                at = np.uint64((16 * part + 4 * x) << merged)
                to = (part * side + x) * width + word
                any_in[to] |= _bits(some >> at, merged) << shift
                all_in[to] |= _bits(every >> at, merged) << shift
    return a_first, a_end


@njit(cache=True, nogil=True)
def _bits(row, merged):
    """Bits of the blocks along b of a row of cells."""
    if merged == 0:
        return row & np.uint64(15)
    if merged == 1:
        return row & _ONE | row >> _ONE & np.uint64(2)
    return row & _ONE


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


@njit(cache=True, nogil=True)
def _turned(mask, m):
    """A brick's mask with depth as its first axis, a and b as the others."""
    if m > 0:
        for k in range(4):
            moved, shift = _TURNS[m - 1, k, 0], _TURNS[m - 1, k, 1]
            swapped = (mask >> shift ^ mask) & moved
            mask ^= swapped ^ swapped << shift
    return mask


@njit(cache=True, nogil=True, error_model="numpy")
def shift_rows(rows, any_in, all_in, to, passing, within, spans):
    """Cast rows of blocks on tiles as wide as they, by words.

    Args:
        rows: first a and the end, the slab's first row in `any_in`, width, words, and columns of
            tiles. any_in, all_in: see `gather_blocks`. to: for b, see `projection`.
        passing, within: (side words,), filled: tiles any ray of which passes a block of `any_in`,
            and all rays of which pass blocks of `all_in`.
        spans: (side, 3), filled: of each row the words of `passing` that are not 0, [first, end),
            and whether `within` is anywhere.
    """
    a_first, a_end, part, width, words, _ = rows
    offset, last = first_tile(0, to), last_tile(0, to)
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
def project_rows(rows, any_in, all_in, to, passing, within, spans):
    """`shift_rows` on tiles of other widths, by runs of blocks."""
    a_first, a_end, part, width, words, columns = rows
    for a in range(a_first, a_end):
        cells, tiles = (part + a) * width, a * words
        for k in range(tiles, tiles + words):
            passing[k] = within[k] = 0
        spans[a, 0], spans[a, 1], spans[a, 2] = words, 0, 0
        start, stop = _next_run(any_in, cells, width, 0)
        while start < stop:
            j, j_end = max(first_tile(start, to), 0), min(last_tile(stop - 1, to) + 1, columns)
            if j < j_end:
                _set_bits(passing, tiles, j, j_end - 1)
                spans[a, 0], spans[a, 1] = min(spans[a, 0], j >> 6), (j_end - 1 >> 6) + 1
            start, stop = _next_run(any_in, cells, width, stop)
        start, stop = _next_run(all_in, cells, width, 0)
        while start < stop:
            j, j_end = max(last_tile(start - 1, to) + 1, 0), min(first_tile(stop, to), columns)
            if j < j_end:
                _set_bits(within, tiles, j, j_end - 1)
                spans[a, 2] = 1
            start, stop = _next_run(all_in, cells, width, stop)


@njit(cache=True, nogil=True)
def _next_run(cells, at, width, bit):
    """Next run of set bits of a row at or after a bit: [start, stop), empty at the end."""
    k, end = bit >> 6, WORD * width
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
    start += WORD * k
    while word == 0:
        k += 1
        if k == width:
            return start, end
        word = ~cells[at + k]
    return start, np.int64(trailing_zeros(word)) + WORD * k


@njit(cache=True, nogil=True)
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

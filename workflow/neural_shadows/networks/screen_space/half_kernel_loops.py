"""Loops of the per-pixel kernel filter by small logits of half the resolution: half the exponentials.

Enlarged bilinearly, a pixel's logit is ¾ of that of one half-resolution column and ¼ of its
neighbour's. So its weight is a product: the cubed fourth root of one exponential, and the fourth root
of the other. Even and odd pixels are filtered apart: their values lie side by side for vector
instructions. The four levels of 2048 × 1024 pixels take 43 ms of a core with AVX-512 instead of 62.
"""

import numpy as np
from numba import njit

from neural_shadows.networks.screen_space.kernel_taps import (
    FAR,
    LOG2_E,
    NEAR,
    SIDE,
    TAPS,
    exp2,
    half_columns,
    half_rows,
)

HALF_BLOCK = 1024  # half-resolution columns at once; 512 takes a tenth more, 256 a half
# Largest magnitude of small logits, as bits. Weights are within e^±40: floats without a logit subtracted.
# Of networks trained for 600 to 6,000 steps the largest in 18 test windows is 13 to 27.
_LARGEST = np.float32(40).view(np.int32)
_MAGNITUDE = np.int32(0x7FFFFFFF)  # all bits but the sign
_OF_NEAR, _OF_FAR = LOG2_E * NEAR / 4, LOG2_E * FAR / 4  # for the fourth root
_FLOATS_OF_A_LINE = 16  # of the cache
# Indices without a sign, of whole arrays. Numba makes room for negative ones, and counts references to
# slices: both cost more here than the arithmetic.
_index = np.uint64


@njit(cache=True, nogil=True, error_model="numpy")
def filter_small_rows(bits, step, source, guide, limit, begin, end, result, first_row):
    """Fill those of rows begin … end whose logits are all of small magnitude.

    Args:
        See `pixel_kernel_loops.filter_rows`; logits are of half the resolution.

    Returns:
        Whether they are filled, (end − begin,).
    """
    height, width = source.shape
    low, high = max(begin - 2 * step, 0), min(end + 2 * step, height)
    values = _by_parity(source, low, high)
    guides = _by_parity(guide, low, high) if limit < np.inf else values
    room = _scratch(width)
    first, last = begin - first_row, end - 1 - first_row
    small = _are_small(bits, max(first // 2 - 1, 0), min(last // 2 + 2, bits.shape[1]))
    filled = np.zeros(end - begin, np.bool_)
    for y in range(begin, end):
        near, far = half_rows(y - first_row, bits.shape[1])
        if small[near] and small[far]:
            _filter_row(bits, near, far, step, values, guides, limit, y - low, result[y], room)
            filled[y - begin] = True
    return filled


@njit(cache=True, nogil=True)
def _are_small(bits, begin, end):
    """Of rows begin … end of logits, whether all are numbers of small magnitude; False of others: (h,)."""
    small = np.zeros(bits.shape[1], np.bool_)
    for y in range(begin, end):
        largest = np.int32(0)
        for tap in range(TAPS):
            largest = max(largest, _largest_magnitude(bits[tap, y]))
        small[y] = largest <= _LARGEST
    return small


@njit(cache=True, nogil=True)
def _largest_magnitude(row):
    """Bits of a row's largest magnitude; they are ordered as magnitudes are, those of NaN above all."""
    shift = np.int32(32 - 8 * row.itemsize)  # bfloat16 is the upper half of float32
    largest = np.int32(0)
    for i in range(len(row)):
        magnitude = np.int32(np.int32(row[i]) << shift) & _MAGNITUDE
        largest = magnitude if magnitude > largest else largest
    return largest


@njit(cache=True, nogil=True)
def _by_parity(picture, low, high):
    """Rows low … high of a picture (H, W), even pixels and odd ones: (2, high − low, ⌈W / 2⌉)."""
    width = picture.shape[1]
    parities = np.empty((2, high - low, (width + 1) // 2), np.float32)
    for y in range(high - low):
        row, even, odd = picture[low + y], parities[0, y], parities[1, y]
        for i in range(width // 2):
            even[i], odd[i] = row[2 * i], row[2 * i + 1]
        if width % 2:
            even[width // 2] = row[width - 1]
    return parities


@njit(cache=True, nogil=True)
def _scratch(width):
    """Room for `_filter_row` of a picture, in rows that begin at lines of the cache.

    Of n half-resolution columns, HALF_BLOCK at most: fourth roots and their cubes (n + 3,), of one
    column more on the left and two on the right; by parity sums of weights, of weighted values (2, n),
    n rounded up to a line of the cache.
    """
    columns = min((width + 1) // 2, HALF_BLOCK)
    size = 2, -(-columns // _FLOATS_OF_A_LINE) * _FLOATS_OF_A_LINE
    weights, sums = _aligned(2 * size[1]).reshape(size), _aligned(2 * size[1]).reshape(size)
    return _aligned(columns + 3), _aligned(columns + 3), weights, sums


@njit(cache=True, nogil=True)
def _aligned(length):
    """Floats, not set, that begin at a line of the cache."""
    room = np.empty(length + _FLOATS_OF_A_LINE, np.float32)
    begin = (-room.ctypes.data % (4 * _FLOATS_OF_A_LINE)) // 4
    return room[begin : begin + length]


@njit(cache=True, nogil=True, fastmath={"contract"})
def _take_roots(bits, tap, near, far, columns, roots, cubes):
    """Fourth roots of a tap's weights, by half-resolution columns, and their cubes."""
    shift = np.int32(32 - 8 * bits.itemsize)
    begin, end, missing = columns
    first, count, skip = _index(begin), _index(end - begin), _index(missing)
    tap, near, far = _index(tap), _index(near), _index(far)
    for i in range(count):
        a = np.int32(np.int32(bits[tap, near, first + i]) << shift).view(np.float32)
        b = np.int32(np.int32(bits[tap, far, first + i]) << shift).view(np.float32)
        root = exp2(_OF_NEAR * a + _OF_FAR * b)
        roots[skip + i] = root
        cubes[skip + i] = root * root * root
    if missing:
        roots[0] = roots[1]
    roots[skip + count] = roots[skip + count - _index(1)]  # read only beyond the last


@njit(cache=True, nogil=True, fastmath={"contract"})
def _add_tap(roots, cubes, values, guides, limit, here, there, count, weights, sums):
    """Add a tap's weights and weighted values.

    Args:
        here, there: parity, row and column of the first of `count` pixels, and of its tap.
        weights, sums: of the block. The pixels' first column in it is `here`'s fourth number.
    """
    parity, y, begin, first = _index(here[0]), _index(here[1]), _index(here[2]), _index(here[3])
    near, far = first + _index(1), first + _index(2 * here[0])
    of, v, tap = _index(there[0]), _index(there[1]), _index(there[2])
    gated = limit < np.inf
    for i in range(_index(count)):
        weight = cubes[near + i] * roots[far + i]
        if gated:
            difference = abs(guides[of, v, tap + i] - guides[parity, y, begin + i])
            weight = weight if difference <= limit else np.float32(0)
        weights[parity, first + i] += weight
        sums[parity, first + i] += weight * values[of, v, tap + i]


@njit(cache=True, nogil=True, fastmath={"contract"}, error_model="numpy")
def _filter_row(bits, near, far, step, values, guides, limit, y, result, room):
    """Fill a row of a level's result.

    Args:
        near, far: rows of `bits` that it lies between.
        values, guides: of `_by_parity`, and y the row in them. Rows beyond are outside the frame.
        result: (W,) float32.
        room: of `_scratch`, for this width.
    """
    roots, cubes, weights, sums = room
    width = len(result)
    for left in range(0, width, 2 * HALF_BLOCK):
        right = min(left + 2 * HALF_BLOCK, width)
        columns = half_columns(left, right, bits.shape[2])
        weights[:] = 0
        sums[:] = 0
        for tap in range(TAPS):
            v = y + (tap // SIDE - SIDE // 2) * step
            offset = (tap % SIDE - SIDE // 2) * step
            if v < 0 or v >= values.shape[1]:
                continue
            _take_roots(bits, tap, near, far, columns, roots, cubes)
            for parity in range(2):
                x = left + offset + parity  # of the first pixel's tap
                first = max(0, -(x // 2))
                count = max(0, (min(right + offset, width) - x + 1) // 2 - first)
                here = parity, y, left // 2 + first, first
                there = x % 2, v, x // 2 + first
                _add_tap(roots, cubes, values, guides, limit, here, there, count, weights, sums)
        _divide(sums, weights, result[left:right])


@njit(cache=True, nogil=True, fastmath={"contract"}, error_model="numpy")
def _divide(sums, weights, result):
    """Weighted means of both parities, as pixels side by side."""
    for parity in range(2):
        total, weight = sums[parity], weights[parity]
        for i in range(len(total)):
            total[i] /= weight[i]
    even, odd = sums
    for i in range(len(result) // 2):
        result[2 * i], result[2 * i + 1] = even[i], odd[i]
    if len(result) % 2:
        result[len(result) - 1] = even[len(result) // 2]

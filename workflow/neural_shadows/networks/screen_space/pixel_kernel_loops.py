"""Loops of the filter by pixels' own kernels: forward, and back to the kernels and to the picture.

A level's 25 logits of a block of pixels are put into 25 rows, so that a processor works on many
pixels at once; weights live there alone. Renormalised at borders, a softmax is one over the taps
within the frame.
"""

import math

import numpy as np
from numba import njit

SIDE = 5  # taps along and down
TAPS = SIDE**2
_BLOCK = 128  # pixels; even. 25 rows of them and what else is in use lie in the first cache
_NEAR, _FAR = np.float32(0.75), np.float32(0.25)  # shares of two neighbours, enlarged bilinearly
_LOG2_E = np.float32(np.log2(np.e))
# Of 2^f by Taylor, |f| ≤ 1/2.
_C1, _C2, _C3, _C4, _C5, _C6 = (
    np.float32(math.log(2) ** k / math.factorial(k)) for k in range(1, 7)
)
_LEAST = np.float32(-1e30)


@njit(cache=True, nogil=True, inline="always")
def _exp(x):
    """Of x ≤ 0, to 2e-7 of itself; numba's own is a call for each number."""
    t = x * _LOG2_E
    t = t if t > np.float32(-126) else np.float32(-126)
    k = np.floor(t + np.float32(0.5))
    f = t - k
    p = _C6
    p = p * f + _C5
    p = p * f + _C4
    p = p * f + _C3
    p = p * f + _C2
    p = p * f + _C1
    p = p * f + np.float32(1)
    return p * np.int32((np.int32(k) + np.int32(127)) << np.int32(23)).view(np.float32)


@njit(cache=True, nogil=True, inline="always")
def _reach(tap, y, left, right, step, height, width):
    """Row v that a tap reads for pixels (y, left … right), by how far to the right it looks, and for
    which pixels [first, last) of the block it lies within the frame; none if v does not.
    """
    v = y + (tap // SIDE - SIDE // 2) * step
    aside = (tap % SIDE - SIDE // 2) * step
    first, last = max(left, -aside) - left, min(right, width - aside) - left
    if v < 0 or v >= height or last < first:
        return 0, 0, 0, 0
    return v, aside, first, last


@njit(cache=True, nogil=True, inline="always")
def _rows_of(y, factor, rows):
    """The two rows of logits that a row of pixels is between, the nearer first."""
    if factor == 1:
        return y, y
    near = y // 2
    return near, min(max(near + (1 if y % 2 else -1), 0), rows - 1)


@njit(cache=True, nogil=True, fastmath={"contract"})
def _load(bits, factor, y, left, right, channel, halves, planes):
    """The logits of pixels (y, left … right) by tap, into planes (25, block)."""
    near, far = _rows_of(y, factor, bits.shape[0])
    shift = np.int32(32 - 8 * bits.itemsize)  # bfloat16 is the upper half of float32
    if factor == 1:
        for i in range(right - left):
            here = bits[near, left + i, channel : channel + TAPS]
            for tap in range(TAPS):
                planes[tap, i] = np.int32(np.int32(here[tap]) << shift).view(np.float32)
        return
    low, pairs = left // 2 - 1, (right - left + 1) // 2
    for i in range(pairs + 2):
        column = min(max(low + i, 0), bits.shape[1] - 1)
        here = bits[near, column, channel : channel + TAPS]
        there = bits[far, column, channel : channel + TAPS]
        for tap in range(TAPS):
            a = np.int32(np.int32(here[tap]) << shift).view(np.float32)
            b = np.int32(np.int32(there[tap]) << shift).view(np.float32)
            halves[tap, i] = _NEAR * a + _FAR * b
    for tap in range(TAPS):
        half, plane = halves[tap], planes[tap]
        for j in range(pairs):
            plane[2 * j] = _NEAR * half[j + 1] + _FAR * half[j]
            plane[2 * j + 1] = _NEAR * half[j + 1] + _FAR * half[j + 2]


@njit(cache=True, nogil=True, fastmath={"contract"})
def _add(planes, factor, y, left, right, channel, halves, to_logits):
    """Add what belongs to logits of pixels (y, left … right), as `_load` has read them."""
    near, far = _rows_of(y, factor, to_logits.shape[0])
    count = right - left
    if factor == 1:
        for i in range(count):
            here = to_logits[near, left + i, channel : channel + TAPS]
            for tap in range(TAPS):
                here[tap] += planes[tap, i]
        return
    low, pairs = left // 2 - 1, (count + 1) // 2
    for tap in range(TAPS):
        half, plane = halves[tap], planes[tap]
        half[0], half[1], half[pairs + 1] = _FAR * plane[0], 0, 0
        for j in range(pairs):
            half[j + 1] = _NEAR * (plane[2 * j] + plane[2 * j + 1])
        for j in range(1, pairs):
            half[j] += _FAR * plane[2 * j]
            half[j + 1] += _FAR * plane[2 * j - 1]
        half[pairs + 1] += _FAR * plane[2 * pairs - 1]
    for i in range(pairs + 2):
        column = min(max(low + i, 0), to_logits.shape[1] - 1)
        here = to_logits[near, column, channel : channel + TAPS]
        there = to_logits[far, column, channel : channel + TAPS]
        for tap in range(TAPS):
            here[tap] += _NEAR * halves[tap, i]
            there[tap] += _FAR * halves[tap, i]


@njit(cache=True, nogil=True, fastmath={"contract"})
def _weigh(planes, y, left, right, step, height, width, top, total):
    """Logits become exponentials, 0 of taps outside the frame, and `total` their sums."""
    top[:] = _LEAST
    total[:] = 0
    for tap in range(TAPS):
        _, _, first, last = _reach(tap, y, left, right, step, height, width)
        logits, most = planes[tap, first:last], top[first:last]
        for i in range(last - first):
            most[i] = logits[i] if logits[i] > most[i] else most[i]
    for tap in range(TAPS):
        _, _, first, last = _reach(tap, y, left, right, step, height, width)
        plane = planes[tap]
        plane[:first] = 0
        plane[last:] = 0
        logits, most, sums = plane[first:last], top[first:last], total[first:last]
        for i in range(last - first):
            weight = _exp(logits[i] - most[i])
            logits[i] = weight
            sums[i] += weight


@njit(cache=True, nogil=True, fastmath={"contract"}, error_model="numpy")
def filter_rows(bits, factor, level, source, begin, end, result):
    """Fill rows begin … end of a level's result (H, W).

    Args:
        bits: (h, w, levels · 25), the bits of logits in float32 or bfloat16 as integers.
        factor: 1, or 2 where logits are of half the resolution and are enlarged bilinearly.
        source: (H, W) float32, with H ≤ factor · h and W ≤ factor · w.
    """
    height, width = source.shape
    planes = np.empty((TAPS, _BLOCK), np.float32)
    halves = np.empty((TAPS, _BLOCK // 2 + 2), np.float32)
    top, total, sums = np.empty((3, _BLOCK), np.float32)
    for y in range(begin, end):
        for left in range(0, width, _BLOCK):
            right = min(left + _BLOCK, width)
            _load(bits, factor, y, left, right, level * TAPS, halves, planes)
            _weigh(planes, y, left, right, 1 << level, height, width, top, total)
            sums[:] = 0
            for tap in range(TAPS):
                v, aside, first, last = _reach(tap, y, left, right, 1 << level, height, width)
                weights, mean = planes[tap, first:last], sums[first:last]
                seen = source[v, left + aside + first : left + aside + last]
                for i in range(last - first):
                    mean[i] += weights[i] * seen[i]
            filtered = result[y, left:right]
            for i in range(right - left):
                filtered[i] = sums[i] / total[i]


@njit(cache=True, nogil=True, fastmath={"contract"}, error_model="numpy")
def add_gradients(bits, factor, level, source, result, gradient, to_source, to_logits):
    """Add a level's gradients, from that of its result: to those of its source and its logits.

    Args:
        bits, factor, source: as for `filter_rows`. result: what it filled.
        gradient, to_source: (H, W) float32. to_logits: (h, w, levels · 25) float32.
    """
    height, width = source.shape
    planes = np.empty((TAPS, _BLOCK), np.float32)
    halves = np.empty((TAPS, _BLOCK // 2 + 2), np.float32)
    top, total, shares = np.empty((3, _BLOCK), np.float32)
    for y in range(height):
        for left in range(0, width, _BLOCK):
            right = min(left + _BLOCK, width)
            _load(bits, factor, y, left, right, level * TAPS, halves, planes)
            _weigh(planes, y, left, right, 1 << level, height, width, top, total)
            given, mean = gradient[y, left:right], result[y, left:right]
            for i in range(right - left):
                shares[i] = given[i] / total[i]
            for tap in range(TAPS):
                v, aside, first, last = _reach(tap, y, left, right, 1 << level, height, width)
                weights, share, middle = planes[tap, first:last], shares[first:last], mean[first:last]
                seen = source[v, left + aside + first : left + aside + last]
                back = to_source[v, left + aside + first : left + aside + last]
                for i in range(last - first):
                    part = weights[i] * share[i]
                    back[i] += part
                    weights[i] = part * (seen[i] - middle[i])
            _add(planes, factor, y, left, right, level * TAPS, halves, to_logits)

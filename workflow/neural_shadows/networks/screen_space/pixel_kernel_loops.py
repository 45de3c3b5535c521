"""Loops of the per-pixel kernel filter and of its gradients.

A level's 25 logits of a block of pixels are copied into 25 rows for vector instructions; weights
exist only there. Renormalised at borders, a softmax is one over the taps within the frame.
"""

import numpy as np
from numba import njit
from numpy.polynomial import Chebyshev, Polynomial

SIDE = 5  # taps along and down
TAPS = SIDE**2
BLOCK = 512  # pixels; even. 256 is a tenth slower, 128 more
_NEAR, _FAR = np.float32(0.75), np.float32(0.25)  # weights of bilinear enlargement
_LOG2_E = np.float32(np.log2(np.e))
# Coefficients of 2^f, |f| ≤ 1/2, accurate to 1e-7.
_P0, _P1, _P2, _P3, _P4, _P5 = np.float32(
    Chebyshev.interpolate(np.exp2, 5, [-0.5, 0.5]).convert(kind=Polynomial).coef
)
_ROUNDS = np.float32(1.5 * 2**23)
_LEAST = np.float32(-1e30)


@njit(cache=True, nogil=True, inline="always")
def _exp(x):
    """exp(x) for x ≤ 0: to 3e-7 at x = −10; numba's own is a function call."""
    t = x * _LOG2_E
    t = np.float32(-126) if t < np.float32(-126) else t  # NaN stays NaN
    rounded = np.float32(t + _ROUNDS)  # its last bits are t rounded
    f = t - (rounded - _ROUNDS)
    p = ((((_P5 * f + _P4) * f + _P3) * f + _P2) * f + _P1) * f + _P0
    power = np.int32(np.int32(rounded.view(np.int32) << 23) + np.int32(0x3F800000))
    return p * power.view(np.float32)


@njit(cache=True, nogil=True)
def _block_row():
    """A block's row; rows of a 2-D array are strided to numba, and slow."""
    return np.empty(BLOCK, np.float32)


@njit(cache=True, nogil=True)
def _tap_span(tap, y, left, right, step, height, width):
    """Row and span of a tap for pixels (y, left … right).

    Returns row v, the offset to the right, and the block's pixels [first, last) with the tap inside
    the frame; zeros if v is outside.
    """
    v = y + (tap // SIDE - SIDE // 2) * step
    offset = (tap % SIDE - SIDE // 2) * step
    first, last = max(left, -offset) - left, min(right, width - offset) - left
    if v < 0 or v >= height or last < first:
        return 0, 0, 0, 0
    return v, offset, first, last


@njit(cache=True, nogil=True)
def _half_span(y, left, right, rows, columns):
    """Half-resolution rows (nearer, farther), columns [begin, end), number missing in front."""
    near = y // 2
    far = min(max(near + (1 if y % 2 else -1), 0), rows - 1)
    low, high = left // 2 - 1, (right + 1) // 2 + 1
    return near, far, max(low, 0), min(high, columns), int(low < 0)


@njit(cache=True, nogil=True, fastmath={"contract"})
def _load(bits, factor, y, left, right, half, planes):
    """Load the logits of pixels (y, left … right) into planes (25, block)."""
    shift = np.int32(32 - 8 * bits.itemsize)  # bfloat16 is the upper half of float32
    _, rows, columns = bits.shape
    if factor == 1:
        for tap in range(TAPS):
            row, plane = bits[tap, y, left:right], planes[tap]
            for i in range(len(row)):
                plane[i] = np.int32(np.int32(row[i]) << shift).view(np.float32)
        return
    near, far, begin, end, missing = _half_span(y, left, right, rows, columns)
    pairs, inner = (right - left + 1) // 2, half[missing:]
    for tap in range(TAPS):
        near_row, far_row = bits[tap, near, begin:end], bits[tap, far, begin:end]
        plane = planes[tap]
        for i in range(len(near_row)):
            a = np.int32(np.int32(near_row[i]) << shift).view(np.float32)
            b = np.int32(np.int32(far_row[i]) << shift).view(np.float32)
            inner[i] = _NEAR * a + _FAR * b
        inner[end - begin] = inner[end - begin - 1]  # read only beyond the last
        if missing:
            half[0] = half[1]
        for j in range(pairs):
            plane[2 * j] = _NEAR * half[j + 1] + _FAR * half[j]
            plane[2 * j + 1] = _NEAR * half[j + 1] + _FAR * half[j + 2]


@njit(cache=True, nogil=True, fastmath={"contract"})
def _add(planes, factor, y, left, right, half, to_logits):
    """Add gradients of logits of pixels (y, left … right), inverse to `_load`."""
    _, rows, columns = to_logits.shape
    if factor == 1:
        for tap in range(TAPS):
            row, plane = to_logits[tap, y, left:right], planes[tap]
            for i in range(len(row)):
                row[i] += plane[i]
        return
    near, far, begin, end, missing = _half_span(y, left, right, rows, columns)
    pairs, inner = (right - left + 1) // 2, half[missing:]
    for tap in range(TAPS):
        plane = planes[tap]
        for j in range(1, pairs - 1):
            pair = plane[2 * j] + plane[2 * j + 1]
            half[j + 1] = _NEAR * pair + _FAR * (plane[2 * j - 1] + plane[2 * j + 2])
        last = 2 * pairs - 1
        half[0], half[pairs + 1] = _FAR * plane[0], _FAR * plane[last]
        half[1] = _NEAR * (plane[0] + plane[1])
        half[pairs] = _NEAR * (plane[last - 1] + plane[last])
        if pairs > 1:
            half[1] += _FAR * plane[2]
            half[pairs] += _FAR * plane[last - 2]
        if missing:
            half[1] += half[0]
        if missing + end - begin < pairs + 2:
            half[pairs] += half[pairs + 1]
        near_row, far_row = to_logits[tap, near, begin:end], to_logits[tap, far, begin:end]
        for i in range(len(near_row)):
            near_row[i] += _NEAR * inner[i]
        for i in range(len(far_row)):
            far_row[i] += _FAR * inner[i]


@njit(cache=True, nogil=True, fastmath={"contract"})
def _gate(planes, guide, limit, y, left, right, step, height, width):
    """Make taps negligible whose guide differs from the pixel's by more than a limit."""
    for tap in range(TAPS):
        v, offset, first, last = _tap_span(tap, y, left, right, step, height, width)
        logits, own = planes[tap, first:last], guide[y, left + first : left + last]
        others = guide[v, left + offset + first : left + offset + last]
        for i in range(last - first):
            logits[i] = logits[i] if abs(others[i] - own[i]) <= limit else _LEAST


@njit(cache=True, nogil=True, fastmath={"contract"})
def _find_top(planes, y, left, right, step, height, width, top):
    """Largest logits of taps inside the frame."""
    top[:] = _LEAST
    for tap in range(TAPS):
        _, _, first, last = _tap_span(tap, y, left, right, step, height, width)
        logits, maxima = planes[tap, first:last], top[first:last]
        for i in range(last - first):
            maxima[i] = logits[i] if logits[i] > maxima[i] else maxima[i]


@njit(cache=True, nogil=True, fastmath={"contract"})
def _exponentiate(planes, y, left, right, step, height, width, top, total):
    """Replace logits by exponentials, 0 outside the frame; sum into `total`."""
    _find_top(planes, y, left, right, step, height, width, top)
    total[:] = 0
    for tap in range(TAPS):
        _, _, first, last = _tap_span(tap, y, left, right, step, height, width)
        plane = planes[tap]
        plane[:first] = 0
        plane[last:] = 0
        logits, maxima, sums = plane[first:last], top[first:last], total[first:last]
        for i in range(last - first):
            weight = _exp(logits[i] - maxima[i])
            logits[i] = weight
            sums[i] += weight


@njit(cache=True, nogil=True, fastmath={"contract"}, error_model="numpy")
def filter_rows(bits, factor, step, source, guide, limit, begin, end, result, first_row):
    """Fill rows begin … end of a level's result (H, W).

    Args:
        bits: (25, h, w), the bits of logits in float32 or bfloat16 as integers.
        factor: 1, or 2 where logits are of half the resolution and are enlarged bilinearly.
        step: pixels from tap to tap.
        source: (H, W) float32, with H ≤ factor · h and W ≤ factor · w.
        guide: likewise, and the limit to its differences within a kernel; ∞ for none.
        first_row: row of the result at the beginning of `bits`. Not by default: a call without it
            would be compiled apart.
    """
    height, width = source.shape
    planes, half = np.empty((TAPS, BLOCK), np.float32), np.empty(BLOCK // 2 + 3, np.float32)
    top, total, sums = _block_row(), _block_row(), _block_row()
    for y in range(begin, end):
        for left in range(0, width, BLOCK):
            right = min(left + BLOCK, width)
            _load(bits, factor, y - first_row, left, right, half, planes)
            if limit < np.inf:
                _gate(planes, guide, limit, y, left, right, step, height, width)
            _find_top(planes, y, left, right, step, height, width, top)
            total[:] = 0
            sums[:] = 0
            for tap in range(TAPS):
                v, offset, first, last = _tap_span(tap, y, left, right, step, height, width)
                logits, maxima = planes[tap, first:last], top[first:last]
                weights, mean = total[first:last], sums[first:last]
                values = source[v, left + offset + first : left + offset + last]
                for i in range(last - first):
                    weight = _exp(logits[i] - maxima[i])
                    weights[i] += weight
                    mean[i] += weight * values[i]
            filtered = result[y, left:right]
            for i in range(right - left):
                filtered[i] = sums[i] / total[i]


@njit(cache=True, nogil=True, fastmath={"contract"}, error_model="numpy")
def add_gradients(bits, factor, step, source, guide, limit, result, gradient, to_source, to_logits):
    """Add a level's gradients to source and logits.

    Args:
        bits, factor, step, source, guide, limit: as for `filter_rows`. result: its output.
        gradient, to_source: (H, W) float32. to_logits: (25, h, w) float32.
    """
    height, width = source.shape
    planes, half = np.empty((TAPS, BLOCK), np.float32), np.empty(BLOCK // 2 + 3, np.float32)
    top, total, shares = _block_row(), _block_row(), _block_row()
    for y in range(height):
        for left in range(0, width, BLOCK):
            right = min(left + BLOCK, width)
            _load(bits, factor, y, left, right, half, planes)
            if limit < np.inf:
                _gate(planes, guide, limit, y, left, right, step, height, width)
            _exponentiate(planes, y, left, right, step, height, width, top, total)
            to_result, mean = gradient[y, left:right], result[y, left:right]
            for i in range(right - left):
                shares[i] = to_result[i] / total[i]
            for tap in range(TAPS):
                v, offset, first, last = _tap_span(tap, y, left, right, step, height, width)
                weights, share, middle = (
                    planes[tap, first:last],
                    shares[first:last],
                    mean[first:last],
                )
                values = source[v, left + offset + first : left + offset + last]
                to_values = to_source[v, left + offset + first : left + offset + last]
                for i in range(last - first):
                    part = weights[i] * share[i]
                    to_values[i] += part
                    weights[i] = part * (values[i] - middle[i])
            _add(planes, factor, y, left, right, half, to_logits)

"""Loops of the per-pixel kernel filter and of its gradients.

A level's 25 logits of a block of pixels are copied into 25 rows for vector instructions; weights
exist only there. Renormalised at borders, a softmax is one over the taps within the frame. Rows of small
logits of half the resolution take less time: see `filter_small_rows`.
"""

import numpy as np
from numba import njit

from neural_shadows.networks.screen_space.half_kernel_loops import filter_small_rows
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

BLOCK = 512  # pixels; even. 256 is a tenth slower, 128 more
_LEAST = np.float32(-1e30)


@njit(cache=True, nogil=True, inline="always")
def _exp(x):
    """exp(x) for x ≤ 0; NaN stays NaN."""
    t = x * LOG2_E
    return exp2(np.float32(-126) if t < np.float32(-126) else t)


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
    near, far = half_rows(y, rows)
    begin, end, missing = half_columns(left, right, columns)
    pairs, inner = (right - left + 1) // 2, half[missing:]
    for tap in range(TAPS):
        near_row, far_row = bits[tap, near, begin:end], bits[tap, far, begin:end]
        plane = planes[tap]
        for i in range(len(near_row)):
            a = np.int32(np.int32(near_row[i]) << shift).view(np.float32)
            b = np.int32(np.int32(far_row[i]) << shift).view(np.float32)
            inner[i] = NEAR * a + FAR * b
        inner[end - begin] = inner[end - begin - 1]  # read only beyond the last
        if missing:
            half[0] = half[1]
        for j in range(pairs):
            plane[2 * j] = NEAR * half[j + 1] + FAR * half[j]
            plane[2 * j + 1] = NEAR * half[j + 1] + FAR * half[j + 2]


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
    near, far = half_rows(y, rows)
    begin, end, missing = half_columns(left, right, columns)
    pairs, inner = (right - left + 1) // 2, half[missing:]
    for tap in range(TAPS):
        plane = planes[tap]
        for j in range(1, pairs - 1):
            pair = plane[2 * j] + plane[2 * j + 1]
            half[j + 1] = NEAR * pair + FAR * (plane[2 * j - 1] + plane[2 * j + 2])
        last = 2 * pairs - 1
        half[0], half[pairs + 1] = FAR * plane[0], FAR * plane[last]
        half[1] = NEAR * (plane[0] + plane[1])
        half[pairs] = NEAR * (plane[last - 1] + plane[last])
        if pairs > 1:
            half[1] += FAR * plane[2]
            half[pairs] += FAR * plane[last - 2]
        if missing:
            half[1] += half[0]
        if missing + end - begin < pairs + 2:
            half[pairs] += half[pairs + 1]
        near_row, far_row = to_logits[tap, near, begin:end], to_logits[tap, far, begin:end]
        for i in range(len(near_row)):
            near_row[i] += NEAR * inner[i]
        for i in range(len(far_row)):
            far_row[i] += FAR * inner[i]


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


def filter_rows(bits, factor, step, source, guide, limit, begin, end, result, first_row):
    """Fill rows begin … end of a level's result (H, W).

    Args:
        bits: (25, h, w), the bits of logits in float32 or bfloat16 as integers.
        factor: 1, or 2 where logits are of half the resolution and are enlarged bilinearly.
        step: pixels from tap to tap.
        source: (H, W) float32, with H ≤ factor · h and W ≤ factor · w.
        guide: likewise, and the limit to its differences within a kernel; ∞ for none.
        first_row: row of the result at the beginning of `bits`.
    """
    level = step, source, guide, limit, begin, end, result, first_row
    # One after the other: compiled into one function, the former takes up to four times as long. It is
    # 1.0 to 2.2 times as fast as the latter, but of rows of 256 pixels with AVX-512: 0.7 to 0.9.
    if factor == 2:
        filled = filter_small_rows(bits, *level)
    else:
        filled = np.zeros(end - begin, np.bool_)
    if not filled.all():
        _filter_others(filled, bits, factor, *level)


@njit(cache=True, nogil=True)
def _filter_others(filled, bits, factor, step, source, guide, limit, begin, end, result, first_row):
    planes, half = np.empty((TAPS, BLOCK), np.float32), np.empty(BLOCK // 2 + 3, np.float32)
    room = planes, half, _block_row(), _block_row(), _block_row()
    for y in range(begin, end):
        if not filled[y - begin]:
            _filter_row(bits, factor, step, source, guide, limit, y, y - first_row, result[y], room)


@njit(cache=True, nogil=True, fastmath={"contract"}, error_model="numpy")
def _filter_row(bits, factor, step, source, guide, limit, y, row, result, room):
    """Fill row y of a level's result, `row` of the enlarged `bits`, by logits of any size."""
    height, width = source.shape
    planes, half, top, total, sums = room
    for left in range(0, width, BLOCK):
        right = min(left + BLOCK, width)
        _load(bits, factor, row, left, right, half, planes)
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
        filtered = result[left:right]
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

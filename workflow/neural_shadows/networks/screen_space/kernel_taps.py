"""What both loops of the per-pixel kernel filter share: taps, exponentials, half-resolution pixels."""

import numpy as np
from numba import njit
from numpy.polynomial import Chebyshev, Polynomial

SIDE = 5  # taps along and down
TAPS = SIDE**2
NEAR, FAR = np.float32(0.75), np.float32(0.25)  # weights of bilinear enlargement
LOG2_E = np.float32(np.log2(np.e))
# Coefficients of 2^f, |f| ≤ 1/2, accurate to 1e-7.
_P0, _P1, _P2, _P3, _P4, _P5 = np.float32(
    Chebyshev.interpolate(np.exp2, 5, [-0.5, 0.5]).convert(kind=Polynomial).coef
)
_ROUNDS = np.float32(1.5 * 2**23)


@njit(cache=True, nogil=True, inline="always")
def exp2(t):
    """2^t for −126 ≤ t < 127, to a share of 2.2e-7; numba's own is a function call. NaN stays NaN."""
    rounded = np.float32(t + _ROUNDS)  # its last bits are t rounded
    f = t - (rounded - _ROUNDS)
    p = ((((_P5 * f + _P4) * f + _P3) * f + _P2) * f + _P1) * f + _P0
    power = np.int32(np.int32(rounded.view(np.int32) << 23) + np.int32(0x3F800000))
    return p * power.view(np.float32)


@njit(cache=True, nogil=True)
def half_rows(y, rows):
    """Half-resolution rows of row y: nearer, farther."""
    near = y // 2
    return near, min(max(near + (1 if y % 2 else -1), 0), rows - 1)


@njit(cache=True, nogil=True)
def half_columns(left, right, columns):
    """Half-resolution columns [begin, end) of pixels left … right, number missing in front."""
    low, high = left // 2 - 1, (right + 1) // 2 + 1
    return max(low, 0), min(high, columns), int(low < 0)

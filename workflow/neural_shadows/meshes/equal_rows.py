"""Equal rows of integers, found by hashing."""

import numpy as np
from numba import njit

_MULTIPLIERS = np.array([0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9], np.uint64)


def first_equal(rows: np.ndarray) -> np.ndarray:
    """Index of the first row equal to each, (n,) int64.

    Args:
        rows: (n, 3) integers.
    """
    slots = 1 << max(int(2 * len(rows)).bit_length(), 4)
    return _first_equal(np.ascontiguousarray(rows, np.int64), np.full(slots, -1, np.int64))


@njit(cache=True, nogil=True)
def _first_equal(rows, table):
    """Args: table: (slots,) of −1, a power of two and more than rows."""
    first, most = np.empty(len(rows), np.int64), np.uint64(len(table) - 1)
    for n in range(len(rows)):
        mixed = np.uint64(0)
        for k in range(3):
            mixed = (mixed ^ np.uint64(rows[n, k])) * _MULTIPLIERS[k]
            mixed ^= mixed >> np.uint64(29)
        slot = mixed & most
        while True:
            other = table[slot]
            if other < 0:
                table[slot] = other = n
            if (
                rows[other, 0] == rows[n, 0]
                and rows[other, 1] == rows[n, 1]
                and rows[other, 2] == rows[n, 2]
            ):
                first[n] = other
                break
            slot = slot + np.uint64(1) & most
    return first

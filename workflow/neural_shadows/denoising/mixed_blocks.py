"""Blocks of a visibility picture near both light and shadow."""

import numpy as np
from numba import njit

SIDE = 32  # pixels of a row filtered, or skipped, together
REACH = 8  # of a pixel's neighbourhood, to each side
# A single ray of four a pixel that differs shifts a mean by 2.7e-5 from the neighbourhood's corner, one of
# eight by 1.3e-5.
_MIXED = np.float32(1e-5)


class Neighbourhoods:
    """Means round the pixels of pictures (height, width); keeps its buffers."""

    def __init__(self, height: int, width: int):
        kernel = np.exp(-3 * (np.arange(-REACH, REACH + 1) / (REACH + 1)) ** 2)
        self._kernel = np.float32(kernel / kernel.sum())
        self._across = np.empty((height, width), np.float32)
        self.mean = np.empty((height, width), np.float32)
        self.mixed = np.empty((height, -(-width // SIDE)), np.bool_)

    def see(self, visibility: np.ndarray) -> None:
        """Fill `mean` and `mixed`.

        `mean` is Gaussian over 17 × 17 pixels; `mixed` is True for blocks of `SIDE` pixels in a row
        with a mean neither 0 nor 1.

        Args:
            visibility: (H, W) float32, repeated beyond its rim.
        """
        _fill_means(visibility, self._kernel, self._across, self.mean)
        _fill_mixed(self.mean, self.mixed)


@njit(cache=True, nogil=True, fastmath=True, error_model="numpy")
def _fill_means(picture, kernel, across, mean):
    height, width = picture.shape
    row = np.empty(width + 2 * REACH, np.float32)
    for y in range(height):
        for x in range(len(row)):  # assignments of slices compile longer: 6.6 s for 2.9
            row[x] = picture[y, min(max(x - REACH, 0), width - 1)]
        for x in range(width):
            across[y, x] = mean[y, x] = 0
        for k in range(len(kernel)):
            for x in range(width):
                across[y, x] += kernel[k] * row[x + k]
    for y in range(height):
        for k in range(len(kernel)):
            v = min(max(y + k - REACH, 0), height - 1)
            for x in range(width):
                mean[y, x] += kernel[k] * across[v, x]


@njit(cache=True, nogil=True)
def _fill_mixed(mean, mixed):
    height, width = mean.shape
    for y in range(height):
        for block in range(mixed.shape[1]):
            begin = block * SIDE
            block_means = mean[y, begin : min(begin + SIDE, width)]
            mixed[y, block] = block_means.min() < 1 - _MIXED and block_means.max() > _MIXED

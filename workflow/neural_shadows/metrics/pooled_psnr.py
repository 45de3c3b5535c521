"""Pooled PSNR of views, from their mean squared error.

The mean of PSNRs is driven by frames that are identical to the reference, whose PSNR is 100 dB by
agreement: a 1024² map on the landscape has 47.6 dB on average, without its two identical frames of
24 42.8, and 42.0 pooled.
"""

import numpy as np

IDENTICAL = 100.0  # dB: the most that `kinds.psnr` gives


def mse_of(psnr: np.ndarray) -> np.ndarray:
    """Mean squared errors of PSNRs in dB for peak 1. Of any shape; 100 dB count as 1e-10."""
    return 10 ** (-np.asarray(psnr, dtype=np.float64) / 10)


def psnr_of(mse: np.ndarray) -> np.ndarray:
    """PSNRs of mean squared errors > 0, in dB for peak 1."""
    return -10 * np.log10(mse)


def identical(psnr: np.ndarray) -> int:
    """Number of views that equal their reference."""
    return int(np.count_nonzero(np.asarray(psnr) >= IDENTICAL))

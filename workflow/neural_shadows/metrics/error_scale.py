"""Metrics as errors that fall to 0, and back. Power laws are fitted to them."""

import numpy as np

from neural_shadows.metrics.pooled_psnr import mse_of, psnr_of


def error_of(metric: str, value: np.ndarray) -> np.ndarray:
    """A metric's error.

    PSNR as mean squared error, SSIM as 1 − SSIM; loss, LPIPS, FLIP and shares as they are.
    """
    match metric:
        case "psnr":
            return mse_of(value)
        case "ssim":
            return 1 - value
    return value


def value_of(metric: str, error: np.ndarray) -> np.ndarray:
    """A metric's value from its `error_of`."""
    match metric:
        case "psnr":
            return psnr_of(error)
        case "ssim":
            return 1 - error
    return error

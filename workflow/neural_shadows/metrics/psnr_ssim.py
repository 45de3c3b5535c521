"""PSNR and SSIM of grey frames (H, W) in [0, 1]. Both raise ValueError for any other pair."""

import numpy as np
from skimage.metrics import structural_similarity

from neural_shadows.metrics.grey_images import check_pair


def psnr(image: np.ndarray, reference: np.ndarray) -> float:
    """Peak signal-to-noise ratio in dB for peak 1, at most 100 (identical frames)."""
    check_pair(image, reference)
    mean_square = np.mean(np.square(image - reference, dtype=np.float64))
    return float(-10 * np.log10(max(mean_square, 1e-10)))  # 1e-10 is 100 dB


def ssim(image: np.ndarray, reference: np.ndarray) -> float:
    """Mean structural similarity. Wang et al. 2004: Gaussian window of sigma 1.5, range 1.

    Frames must have at least 11 pixels a side, the window's.
    """
    check_pair(image, reference)
    return float(
        structural_similarity(
            image,
            reference,
            gaussian_weights=True,
            sigma=1.5,
            use_sample_covariance=False,
            data_range=1.0,
        )
    )

"""PSNR and SSIM of grey frames."""

import numpy as np
from skimage.metrics import structural_similarity

from neural_shadows.metrics.grey_images import check_grey


def psnr(image: np.ndarray, reference: np.ndarray) -> float:
    """Peak signal-to-noise ratio in dB for peak 1, at most 100 (identical frames).

    Raises:
        ValueError: the images are no pair of grey images in [0, 1].
    """
    check_grey(reference)
    check_grey(image, reference.shape)
    mean_square = np.mean(np.square(image - reference, dtype=np.float64))
    return float(-10 * np.log10(max(mean_square, 1e-10)))  # 1e-10 is 100 dB


def ssim(image: np.ndarray, reference: np.ndarray) -> float:
    """Mean structural similarity (Wang et al. 2004: Gaussian window of sigma 1.5, range 1).

    Raises:
        ValueError: the images are no pair of grey images in [0, 1], or have a side
            shorter than the window's 11 pixels.
    """
    check_grey(reference)
    check_grey(image, reference.shape)
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

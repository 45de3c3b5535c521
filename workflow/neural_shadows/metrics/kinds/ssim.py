"""Structural similarity of grey frames."""

import numpy as np

from neural_shadows.metrics.grey_images import check_pair
from neural_shadows.metrics.metric import Metric

METRICS = {"ssim": Metric("SSIM", better="high")}


def of_images(image: np.ndarray, reference: np.ndarray) -> dict[str, float]:
    return {"ssim": ssim(image, reference)}


def ssim(image: np.ndarray, reference: np.ndarray) -> float:
    """Mean structural similarity. Wang et al. 2004: Gaussian window of sigma 1.5, range 1.

    Frames must have at least 11 pixels a side, the window's.

    Raises:
        ValueError: no pair of grey frames (H, W) in [0, 1].
    """
    from skimage.metrics import structural_similarity

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

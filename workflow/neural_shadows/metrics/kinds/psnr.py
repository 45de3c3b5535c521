"""PSNR of grey frames, pooled by their mean squared error."""

import numpy as np

from neural_shadows.metrics.grey_images import check_pair
from neural_shadows.metrics.metric import Metric
from neural_shadows.metrics.pooled_psnr import mse_of, psnr_of

_PSNR = {"unit": "dB", "digits": 2, "better": "high", "to_error": mse_of, "from_error": psnr_of}
METRICS = {
    # Tables of soft shadows have that of the mean squared error of visibility.
    "psnr": Metric("PSNR", **_PSNR, lights=("hard",)),
    "psnr_pooled": Metric("pooled PSNR", **_PSNR, lights=()),
}


def of_images(image: np.ndarray, reference: np.ndarray) -> dict[str, float]:
    return {"psnr": psnr(image, reference)}


def psnr(image: np.ndarray, reference: np.ndarray) -> float:
    """Peak signal-to-noise ratio in dB for peak 1, at most 100 (identical frames).

    Raises:
        ValueError: no pair of grey frames (H, W) in [0, 1].
    """
    check_pair(image, reference)
    mean_square = np.mean(np.square(image - reference, dtype=np.float64))
    return float(-10 * np.log10(max(mean_square, 1e-10)))  # 1e-10 is 100 dB

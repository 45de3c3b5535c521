"""LDR-FLIP of grey images (Andersson et al. 2020), by NVIDIA's `flip-evaluator`.

For images seen at 67 pixels a degree: a 3840-pixel, 0.7 m wide display seen
from 0.7 m, the paper's and the package's default. A frame of 600 x 400 takes 0.28 CPU s.
Tiles of it that differ from the reference would give the same mean but no sooner: shadows differ
all along their outlines.
"""

import numpy as np

from neural_shadows.metrics.grey_images import check_pair
from neural_shadows.metrics.metric import Metric

METRICS = {"flip": Metric("FLIP", slow=True)}


def flip_map(image: np.ndarray, reference: np.ndarray) -> np.ndarray:
    """Error of each pixel, float32 (H, W) in [0, 1]. Between grey sRGB images (H, W) in [0, 1].

    Raises:
        ValueError: the images are no pair of grey images in [0, 1].
    """
    import flip_evaluator

    check_pair(image, reference)
    pair = (np.repeat(np.float32(grey)[..., None], 3, axis=2) for grey in (reference, image))
    error, _, _ = flip_evaluator.evaluate(*pair, "LDR", applyMagma=False, computeMeanError=False)
    return error[..., 0]


def flip(image: np.ndarray, reference: np.ndarray) -> float:
    """Mean of the error map; 0 for identical images. Raises as `flip_map`."""
    return float(flip_map(image, reference).mean(dtype=np.float64))


def of_images(image: np.ndarray, reference: np.ndarray) -> dict[str, float]:
    return {"flip": flip(image, reference)}

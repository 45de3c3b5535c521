"""LDR-FLIP of grey images (Andersson et al. 2020), by NVIDIA's `flip-evaluator`.

For images seen at 67 pixels a degree: a 3840-pixel, 0.7 m wide display seen
from 0.7 m, the paper's and the package's default. A frame of 600 x 400 takes 0.28 CPU s.
Tiles of it that differ from the reference would give the same mean but no sooner: shadows differ
all along their outlines.
"""

import flip_evaluator
import numpy as np

from neural_shadows.metrics.grey_images import check_pair


def flip_map(image: np.ndarray, reference: np.ndarray) -> np.ndarray:
    """Error of each pixel, float32 (H, W) in [0, 1]. Between grey sRGB images (H, W) in [0, 1].

    Raises:
        ValueError: the images are no pair of grey images in [0, 1].
    """
    check_pair(image, reference)
    pair = (np.repeat(np.float32(grey)[..., None], 3, axis=2) for grey in (reference, image))
    error, _, _ = flip_evaluator.evaluate(*pair, "LDR", applyMagma=False, computeMeanError=False)
    return error[..., 0]


def flip(image: np.ndarray, reference: np.ndarray) -> float:
    """Mean of the error map; 0 for identical images. Raises as `flip_map`."""
    return float(flip_map(image, reference).mean(dtype=np.float64))

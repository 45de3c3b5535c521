"""Check of images before metrics."""

import numpy as np


def check_pair(image: np.ndarray, reference: np.ndarray) -> None:
    """Refuse NaN, 0 to 255, and shapes that broadcast. They would give a plausible number.

    Raises:
        ValueError: the two are not grey images (H, W) in [0, 1] of one shape.
    """
    if not image.ndim == reference.ndim == 2 or image.shape != reference.shape:
        raise ValueError(f"not two grey images of one shape: {image.shape}, {reference.shape}")
    for pixels in (image, reference):
        low, high = pixels.min(), pixels.max()
        # Shading in float32 may pass 1 by its rounding.
        if not (low >= -1e-5 and high <= 1 + 1e-5):
            raise ValueError(f"image values must lie in [0, 1]; they span [{low}, {high}]")

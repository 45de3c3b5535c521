"""What the metrics take for an image."""

import numpy as np


def check_grey(image: np.ndarray, shape: tuple[int, ...] | None = None) -> None:
    """Refuse what would give a plausible number: NaN, 0 to 255, shapes that broadcast.

    Raises:
        ValueError: `image` is no grey image (H, W) in [0, 1], or not of `shape`.
    """
    if image.ndim != 2 or shape not in (None, image.shape):
        raise ValueError(f"not a grey image of the reference's shape: {image.shape}, {shape}")
    low, high = image.min(), image.max()
    # Shading in float32 may pass 1 by its rounding.
    if not (low >= -1e-5 and high <= 1 + 1e-5):
        raise ValueError(f"image values must lie in [0, 1]; they span [{low}, {high}]")

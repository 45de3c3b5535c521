"""LDR-FLIP of grey images (Andersson et al. 2020), in a sixth of the time of `flip-evaluator`.

Of greys two of the three channels that NVIDIA's package filters are 0 throughout. A frame of
512 × 256 takes 21 CPU ms and not 139; both means agree to 1e-5 (`test_grey_metrics.py`).

For images that are shown to people at 67 pixels a degree: a 3840-pixel, 0.7 m wide display seen
from 0.7 m, the paper's and the package's default.
"""

import numpy as np
from scipy.ndimage import correlate1d

from neural_shadows.metrics.grey_images import check_pair

_PIXELS_A_DEGREE = 3840 * np.pi / 180
_EYE = np.sqrt(0.0047 / 2) / np.pi * _PIXELS_A_DEGREE  # σ of what it resolves of greys [4.1.1]
_FEATURE = 0.5 * 0.082 * _PIXELS_A_DEGREE  # σ of the detectors of edges and points [4.2]
_LARGEST = 203.30165**0.7  # error of green beside blue, which differ most [4.1.2]
_KNEE, _AT_KNEE = 0.4, 0.95  # what error, in shares of that, becomes what [4.1.3]


def _places(sigma: float, reach: int) -> tuple[np.ndarray, np.ndarray]:
    """Pixels from −reach to reach, and a Gaussian there."""
    x = np.arange(-reach, reach + 1.0)
    return x, np.exp(-0.5 * (x / sigma) ** 2)


def _balanced(kernel: np.ndarray) -> np.ndarray:
    """Its positive weights sum to 1, its negative ones, if it has any, to −1."""
    below = -kernel.clip(max=0).sum()
    return np.where(kernel < 0, kernel / (below or 1), kernel / kernel.clip(0).sum())


_BLUR = _balanced(_places(_EYE, 6)[1])  # beyond, less than 1e-7
_X, _GAUSSIAN = _places(_FEATURE, 9)  # 3 σ
_SMOOTH, _EDGE, _POINT = (
    _balanced(shape * _GAUSSIAN) for shape in (1, -_X, (_X / _FEATURE) ** 2 - 1)
)


def flip_map(image: np.ndarray, reference: np.ndarray) -> np.ndarray:
    """Error of each pixel, float32 (H, W) in [0, 1], between grey sRGB images (H, W) in [0, 1].

    Raises:
        ValueError: the images are no pair of grey images in [0, 1].
    """
    check_pair(image, reference)
    one, other = (_linear(np.float32(grey)) for grey in (image, reference))
    error = np.abs(_lightness(one) - _lightness(other)) ** np.float32(0.7) / np.float32(_LARGEST)
    beyond = _AT_KNEE + (1 - _AT_KNEE) * (error - _KNEE) / (1 - _KNEE)
    error = np.where(error < _KNEE, error * (_AT_KNEE / _KNEE), beyond)
    features = np.abs(_features(one) - _features(other)).max(0)
    return error ** (1 - np.sqrt(features / np.sqrt(np.float32(2))))


def flip(image: np.ndarray, reference: np.ndarray) -> float:
    """Mean of the error map; 0 for identical images. Raises as `flip_map`."""
    return float(flip_map(image, reference).mean(dtype=np.float64))


def _linear(grey: np.ndarray) -> np.ndarray:
    """Luminance of sRGB."""
    grey = grey.clip(0, 1)
    return np.where(grey <= 0.04045, grey / 12.92, ((grey + 0.055) / 1.055) ** np.float32(2.4))


def _lightness(luminance: np.ndarray) -> np.ndarray:
    """L* of what the eye resolves."""
    seen = _filtered(luminance, _BLUR, _BLUR)
    dark = (6 / 29) ** 3
    return np.where(seen > dark, 116 * np.cbrt(seen) - 16, seen * (29 / 3) ** 3)


def _features(luminance: np.ndarray) -> np.ndarray:
    """How much of an edge, and of a point, each pixel is: (2, H, W)."""
    strengths = [
        np.hypot(_filtered(luminance, kind, _SMOOTH), _filtered(luminance, _SMOOTH, kind))
        for kind in (_EDGE, _POINT)
    ]
    return np.stack(strengths)


def _filtered(picture: np.ndarray, down: np.ndarray, along: np.ndarray) -> np.ndarray:
    """By a kernel along columns and one along rows; beyond its rim a picture goes on as it is there."""
    return correlate1d(correlate1d(picture, down, axis=0, mode="nearest"), along, mode="nearest")

"""LDR-FLIP of grey images (Andersson et al. 2020), by tiles.

For images seen at 67 pixels a degree: a 3840-pixel, 0.7 m wide display seen
from 0.7 m, the paper's default. Grey images have no chroma, which leaves separable filters of their
luminance; the error is 0 where no pixel of a filter's support differs. A pair of 600 x 400 takes
0.03 CPU s, by NVIDIA's `flip-evaluator`, which is for all colours, 0.5 s. Means of shadows are equal to
2e-6, of noise to 5e-6; of flat images, whose derivatives' rounding errors it takes the root of, to 2e-5.
"""

from functools import cache

import numpy as np

from neural_shadows.metrics.grey_images import check_pair
from neural_shadows.metrics.metric import Metric

METRICS = {"flip": Metric("FLIP", slow=True)}
PIXELS_PER_DEGREE = 0.7 * 3840 / 0.7 * np.pi / 180
GREEN_TO_BLUE = 41.276099  # the largest colour difference of the paper's, to the power of 0.7
RADIUS = 10  # pixels: of the filters' support
SIDE = 32  # of a tile: products this small are of one thread whatever their number


def flip_map(image: np.ndarray, reference: np.ndarray) -> np.ndarray:
    """Error of each pixel, float32 (H, W) in [0, 1]. Between grey sRGB images (H, W) in [0, 1].

    Raises:
        ValueError: the images are no pair of grey images in [0, 1].
    """
    check_pair(image, reference)
    tiles = [_tiles(np.float32(grey)) for grey in (image, reference)]
    differ = (tiles[0] != tiles[1]).any(axis=(2, 3))
    first, second = (_features(each[differ]) for each in tiles)
    lightness, edges, points = (np.abs(a - b) for a, b in zip(first, second))
    color = lightness**0.7 / GREEN_TO_BLUE
    color = np.where(color < 0.4, color * (0.95 / 0.4), 0.95 + (color - 0.4) * (0.05 / 0.6))
    feature = np.sqrt(np.maximum(edges, points) * 0.5**0.5)
    error = np.zeros((*differ.shape, SIDE, SIDE), np.float32)
    error[differ] = color ** (1 - feature)
    height, width = image.shape
    return error.swapaxes(1, 2).reshape(-1, differ.shape[1] * SIDE)[:height, :width]


def _tiles(grey: np.ndarray) -> np.ndarray:
    """Luminance of tiles with the filters' margin, float32 (rows, columns, n, n)."""
    linear = np.where(grey <= 0.04045, grey / 12.92, ((grey + 0.055) / 1.055) ** 2.4)
    padded = np.pad(linear, [(RADIUS, RADIUS + -side % SIDE) for side in grey.shape], mode="edge")
    windows = np.lib.stride_tricks.sliding_window_view(padded, (SIDE + 2 * RADIUS,) * 2)
    return windows[::SIDE, ::SIDE]


def _features(tiles: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Lightness as seen, strength of edges and of points, (tiles, SIDE, SIDE) each."""
    down, across = _filters() @ tiles[:, None], _filters().swapaxes(1, 2)
    y = (down[:, 0] @ across[0]).clip(0, 1)
    lightness = np.where(y > (6 / 29) ** 3, 116 * np.cbrt(y) - 16, (29 / 3) ** 3 * y)
    edges, points = (
        np.sqrt((down[:, 1] @ across[k]) ** 2 + (down[:, k] @ across[1]) ** 2) for k in (2, 3)
    )
    return lightness, edges, points


@cache
def _filters() -> np.ndarray:
    """Contrast sensitivity, Gaussian, its first and second derivative: (4, SIDE, n) float32."""
    x, sigma = np.arange(-RADIUS, RADIUS + 1.0), 0.5 * 0.082 * PIXELS_PER_DEGREE
    sensitivity = np.exp(-((np.pi * x / PIXELS_PER_DEGREE) ** 2) / 0.0047)
    gauss = np.exp(-0.5 * (x / sigma) ** 2) * (np.abs(x) <= np.ceil(3 * sigma))
    bands = np.zeros((4, SIDE, SIDE + 2 * RADIUS), np.float32)
    for band, weights in zip(
        bands, (sensitivity, gauss, -x * gauss, ((x / sigma) ** 2 - 1) * gauss)
    ):
        # Positive weights have the sum of 1, negative ones of -1.
        sums = weights.clip(max=0).sum(), weights.clip(min=0).sum()
        weights = weights / np.where(weights < 0, -sums[0], sums[1])
        for row in range(SIDE):
            band[row, row : row + 2 * RADIUS + 1] = weights
    return bands


def flip(image: np.ndarray, reference: np.ndarray) -> float:
    """Mean of the error map; 0 for identical images. Raises as `flip_map`."""
    return float(flip_map(image, reference).mean(dtype=np.float64))


def of_images(image: np.ndarray, reference: np.ndarray) -> dict[str, float]:
    return {"flip": flip(image, reference)}

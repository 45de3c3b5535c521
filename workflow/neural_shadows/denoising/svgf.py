"""An SVGF-like spatial filter: edge-stopping wavelet passes guided by variance.

After Schied et al. 2017, "Spatiotemporal variance-guided filtering". "Like", because depths'
gradients come from neighbouring pixels instead of a rasteriser, depths may differ by four times as much,
and the weights' exponential is a vectorisable approximation. All on one thread.
"""

from collections.abc import Iterator
from itertools import count

import numpy as np

from neural_shadows.denoising.trials import Trials
from neural_shadows.denoising.wavelet import (
    fill_moments,
    fill_next,
    fill_sharpness,
    fill_slopes,
)
from neural_shadows.rendering.surface import Surface

SIGMA_LUMINANCE = 4.0  # σ_l, in standard deviations (4.4)
PASSES = 5  # of the 5 × 5 kernel, its taps 1, 2, 4, 8, 16 pixels apart (4.3)


class SvgfFilter:
    """The filter for pictures (height, width); keeps its buffers, so one thread may use it.

    Args:
        sigma: see SIGMA_LUMINANCE.
    """

    def __init__(self, height: int, width: int, sigma: float = SIGMA_LUMINANCE):
        self.sigma = sigma
        self._guides = np.zeros((6, height, width), np.float32)
        self._images = np.empty((6, height, width), np.float32)
        self._row = np.empty(width, np.float32)

    def see(self, depth: np.ndarray, normal: np.ndarray) -> None:
        """See `PassFilter`."""
        self._guides[0] = depth
        self._guides[1:4] = np.moveaxis(normal, 2, 0)
        fill_slopes(self._guides[0], self._guides[4], self._guides[5])

    def variance(self, mean: np.ndarray, square: np.ndarray) -> np.ndarray:
        """Variance over the same surface's pixels of 7 × 7 (4.2).

        Args:
            mean, square: (H, W) float32, the value and its square, or means of them.
        """
        total, first, second = self._images[:3]
        fill_moments(self._guides, mean, square, self._row, total, first, second)
        return np.maximum(second - first * first, 0)

    def noise(self, visibility: np.ndarray) -> np.ndarray:
        """See `PassFilter`."""
        return self.variance(visibility, visibility * visibility)

    def passes(self, visibility: np.ndarray, variance: np.ndarray) -> Iterator[np.ndarray]:
        """See `PassFilter` (4.3)."""
        light, spread, sharpness, total, next_light, next_spread = self._images
        light[:], spread[:] = visibility, variance
        for step in count():
            fill_sharpness(spread, np.float32(self.sigma), sharpness)
            fill_next(
                self._guides,
                light,
                spread,
                sharpness,
                1 << step,
                self._row,
                total,
                next_light,
                next_spread,
            )
            light, next_light = next_light, light
            spread, next_spread = next_spread, spread
            yield np.clip(light, 0, 1)


class SvgfTrials(Trials):
    """Pictures (height, width) without history, by any constants."""

    def __init__(self, height: int, width: int):
        super().__init__(SvgfFilter(height, width))

    def single(
        self,
        visibility: np.ndarray,
        surface: Surface,
        *,
        sigma_luminance: float = SIGMA_LUMINANCE,
        passes: float = PASSES,
    ) -> np.ndarray:
        """Smooth a picture (H, W) float32, see `Trials.after`; constants: see `TemporalFilter`."""
        return self.after(visibility, surface, sigma_luminance, passes)

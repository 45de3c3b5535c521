"""An SVGF-like spatial filter: edge-stopping wavelet passes guided by variance.

After Schied et al. 2017, "Spatiotemporal variance-guided filtering". "Like", because depths'
gradients come from neighbouring pixels instead of a rasteriser, depths may differ by four times as much,
and the weights' exponential is a vectorisable approximation. All on one thread.
"""

from collections.abc import Iterator
from itertools import count, islice

import numpy as np

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
        sigma_luminance: see SIGMA_LUMINANCE. passes: see PASSES.
    """

    def __init__(
        self,
        height: int,
        width: int,
        sigma_luminance: float = SIGMA_LUMINANCE,
        passes: float = PASSES,
    ):
        self.sigma_luminance = np.float32(sigma_luminance)
        self._passes = int(passes)
        self._guides = np.zeros((6, height, width), np.float32)
        self._images = np.empty((6, height, width), np.float32)
        self._row = np.empty(width, np.float32)

    def see(self, depth: np.ndarray, normal: np.ndarray) -> None:
        """Set the surface guiding the weights.

        Args:
            depth: (H, W) float32 along the camera's axis; 0 where there is no surface.
            normal: (H, W, 3) float32, unit; 0 where there is no surface.
        """
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

    def passes(self, visibility: np.ndarray, variance: np.ndarray) -> Iterator[np.ndarray]:
        """A picture (H, W) float32 after each pass (4.3), as many as are asked for.

        Its buffers are the filter's: take no more from it once another is begun.

        Args:
            visibility: (H, W) float32 in [0, 1]. variance: (H, W) float32, of its noise.
        """
        light, spread, sharpness, total, next_light, next_spread = self._images
        light[:], spread[:] = visibility, variance
        for step in count():
            fill_sharpness(spread, self.sigma_luminance, sharpness)
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

    def smooth(self, visibility: np.ndarray, variance: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Smooth a picture (H, W) float32: after first and last pass; see `passes`."""
        pictures = [visibility, *islice(self.passes(visibility, variance), self._passes)]
        return pictures[min(1, self._passes)], pictures[-1]


class SvgfTrials:
    """Pictures (height, width) without history, by any constants.

    While they are of one picture its variance is computed once, and with one σ_l each pass: 24 settings
    take less than a third of their time one by one.
    """

    def __init__(self, height: int, width: int):
        self._filter = SvgfFilter(height, width)
        self._of: tuple[np.ndarray | None, Surface | None] = None, None
        self._variance: np.ndarray | None = None
        self._sigma: float | None = None
        self._pictures: list[np.ndarray] = []  # after no pass, after one, …
        self._further: Iterator[np.ndarray] = iter(())

    def single(
        self,
        visibility: np.ndarray,
        surface: Surface,
        *,
        sigma_luminance: float = SIGMA_LUMINANCE,
        passes: float = PASSES,
    ) -> np.ndarray:
        """Smooth a picture (H, W) float32; neither it nor what is returned may be written to."""
        svgf = self._filter
        if visibility is not self._of[0] or surface is not self._of[1]:
            svgf.see(surface.depth_image(), surface.image(surface.n))
            self._variance = svgf.variance(visibility, visibility * visibility)
            self._of, self._sigma = (visibility, surface), None
        if sigma_luminance != self._sigma:
            self._sigma = sigma_luminance
            svgf.sigma_luminance = np.float32(sigma_luminance)
            self._further, self._pictures = svgf.passes(visibility, self._variance), [visibility]
        missing = int(passes) + 1 - len(self._pictures)
        self._pictures += islice(self._further, max(missing, 0))
        return self._pictures[int(passes)]

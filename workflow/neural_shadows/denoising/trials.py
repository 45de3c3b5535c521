"""Pictures by a filter of several passes, for any of its constants."""

from collections.abc import Iterator
from itertools import islice
from typing import Protocol

import numpy as np

from neural_shadows.rendering.surface import Surface


class PassFilter(Protocol):
    """A filter of pictures (height, width) float32 by passes, each of a wider kernel."""

    sigma: float  # standard deviations of the noise by which visibilities may differ

    def see(self, depth: np.ndarray, normal: np.ndarray) -> None:
        """Set the surface guiding the weights.

        Args:
            depth: (H, W) float32 along the camera's axis; 0 where there is no surface.
            normal: (H, W, 3) float32, unit; 0 where there is no surface.
        """

    def noise(self, visibility: np.ndarray) -> np.ndarray:
        """Variance of a picture's noise, (H, W) float32, by the pixels around."""

    def passes(self, visibility: np.ndarray, variance: np.ndarray) -> Iterator[np.ndarray]:
        """A picture (H, W) float32 after each pass, as many as are asked for.

        Its buffers are the filter's: take no more from it once another is begun.

        Args:
            visibility: (H, W) float32 in [0, 1]. variance: (H, W) float32, of its noise.
        """


def smooth(
    filter_: PassFilter, visibility: np.ndarray, variance: np.ndarray, passes: float
) -> tuple[np.ndarray, np.ndarray]:
    """A picture (H, W) float32 after the first and after the last pass; see `PassFilter.passes`."""
    pictures = [visibility, *islice(filter_.passes(visibility, variance), int(passes))]
    return pictures[min(1, int(passes))], pictures[-1]


class Trials:
    """Pictures of single frames by a filter, for any constants.

    While they are of one picture its noise is estimated once, and with one σ each pass is made once: 24
    settings of the SVGF-like filter take less than a third of their time one by one.
    """

    def __init__(self, filter_: PassFilter):
        self._filter = filter_
        self._of: tuple[np.ndarray | None, Surface | None] = None, None
        self._variance: np.ndarray | None = None
        self._sigma: float | None = None
        self._pictures: list[np.ndarray] = []  # after no pass, after one, …
        self._further: Iterator[np.ndarray] = iter(())

    def after(
        self, visibility: np.ndarray, surface: Surface, sigma: float, passes: float
    ) -> np.ndarray:
        """A picture (H, W) float32 after some passes; neither it nor what is returned may be written to."""
        if visibility is not self._of[0] or surface is not self._of[1]:
            self._filter.see(surface.depth_image(), surface.image(surface.n))
            self._variance = self._filter.noise(visibility)
            self._of, self._sigma = (visibility, surface), None
        if sigma != self._sigma:
            self._filter.sigma = self._sigma = sigma
            self._further = self._filter.passes(visibility, self._variance)
            self._pictures = [visibility]
        missing = int(passes) + 1 - len(self._pictures)
        self._pictures += islice(self._further, max(missing, 0))
        return self._pictures[int(passes)]

"""Temporal accumulation of an SVGF-like filter."""

import numpy as np

from neural_shadows.denoising.history import History
from neural_shadows.denoising.svgf import PASSES, SIGMA_LUMINANCE, SvgfFilter
from neural_shadows.denoising.trials import smooth
from neural_shadows.rendering.reprojection import Reprojection
from neural_shadows.rendering.surface import Surface

SHARE = 0.2  # the least share of a new frame, of values and moments (Schied et al. 2017, 4.1)
_ENOUGH = 4  # frames from which a variance over time is taken instead of one over pixels (4.2)


class TemporalFilter:
    """The filter for a sequence of frames (height, width), given one by one.

    The history is the output of a frame's first pass (4.3).

    Args:
        sigma_luminance: see SIGMA_LUMINANCE. passes: see PASSES. share: see SHARE, of the picture alone.
    """

    def __init__(
        self,
        height: int,
        width: int,
        sigma_luminance: float = SIGMA_LUMINANCE,
        passes: float = PASSES,
        share: float = SHARE,
    ):
        self._spatial = SvgfFilter(height, width, sigma_luminance)
        self._passes, self._share = passes, np.float32(share)
        # The picture, its mean, its mean square, and their number of frames.
        self._history = History()

    def next_frame(
        self, visibility: np.ndarray, surface: Surface, back: Reprojection | None = None
    ) -> np.ndarray:
        """The next frame's picture, (H, W) float32.

        Args:
            visibility: (H, W) float32 in [0, 1].
            back: to the frame before, None at first.
        """
        new = np.stack([visibility, visibility, visibility * visibility, np.ones_like(visibility)])
        self._add_history(new, back)
        picture, mean, square, frames = new
        self._spatial.see(surface.depth_image(), surface.image(surface.n))
        over_time = np.maximum(square - mean * mean, 0)
        over_pixels = self._spatial.variance(mean, square)
        variance = np.where(frames >= _ENOUGH, over_time, over_pixels)
        new[0], last = smooth(self._spatial, picture, variance, self._passes)
        self._history.keep(new)
        return last.copy()  # of no pass it is the history

    def _add_history(self, new: np.ndarray, back: Reprojection | None) -> None:
        """Mix the history of seen points into new (4, H, W).

        The first frames of a point are averaged evenly, as the authors' code does.
        """
        pixels, (*old, frames) = self._history.at(len(new), back)
        frames = np.rint(frames) + 1
        # Moments are of the noise, and need a history where the picture is to have none.
        least = [self._share, np.float32(SHARE), np.float32(SHARE)]
        flat = new.reshape(len(new), -1)
        for image, past, share in zip(flat, old, (np.maximum(each, 1 / frames) for each in least)):
            image[pixels] = past + share * (image[pixels] - past)
        flat[3, pixels] = frames

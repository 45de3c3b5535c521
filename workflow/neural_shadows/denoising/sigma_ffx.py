"""The SIGMA-like filter, then the FFX-like one for remaining noise."""

import numpy as np

from neural_shadows.denoising.ffx import SIGMA, FfxFilter, TemporalFfx, ffx_like
from neural_shadows.denoising.sigma import REACH, SigmaFilter, sigma_like
from neural_shadows.rendering.surface import Surface


class SigmaFfxFilter:
    """Both filters for pictures (height, width), one after the other.

    Args:
        reach: see `SigmaFilter`. sigma: see `FfxFilter`.
    """

    def __init__(self, height: int, width: int, reach: float = REACH, sigma: float = SIGMA):
        self.wide = SigmaFilter(height, width, reach)
        self.fine = FfxFilter(height, width, sigma)


def sigma_ffx_like(
    filter_: SigmaFfxFilter, visibility: np.ndarray, penumbra: np.ndarray, surface: Surface
) -> np.ndarray:
    """Filter one picture without history, (H, W) float32; see `SigmaFilter.smooth`."""
    wide = sigma_like(filter_.wide, visibility, penumbra, surface)
    return ffx_like(filter_.fine, wide, surface.depth_image(), surface.image(surface.n))


class TemporalSigmaFfx:
    """Both filters for a sequence of frames (height, width); the second has the history.

    Args:
        reach: see `SigmaFilter`. sigma: see `FfxFilter`.
    """

    def __init__(self, height: int, width: int, reach: float = REACH, sigma: float = SIGMA):
        self._wide = SigmaFilter(height, width, reach)
        self._fine = TemporalFfx(height, width, sigma)

    def next_frame(
        self,
        visibility: np.ndarray,
        penumbra: np.ndarray,
        surface: Surface,
        was: np.ndarray | None = None,
    ) -> np.ndarray:
        """The next frame's picture, (H, W) float32; see `TemporalSigma.next_frame`."""
        return self._fine.next_frame(
            sigma_like(self._wide, visibility, penumbra, surface), surface, was
        )

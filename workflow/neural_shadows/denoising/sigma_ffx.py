"""The SIGMA-like filter, then the FFX-like one for remaining noise."""

import numpy as np

from neural_shadows.denoising.ffx import SIGMA, FfxFilter, TemporalFfx
from neural_shadows.denoising.sigma import REACH, SigmaFilter
from neural_shadows.rendering.surface import Surface


class SigmaFfxFilter:
    """Both filters for pictures (height, width), one after the other.

    Args:
        reach: see `SigmaFilter`. sigma: see `FfxFilter`.
    """

    def __init__(self, height: int, width: int, reach: float = REACH, sigma: float = SIGMA):
        self._wide = SigmaFilter(height, width, reach, alone=False)
        self._fine = FfxFilter(height, width, sigma)

    def single(self, visibility: np.ndarray, penumbra: np.ndarray, surface: Surface) -> np.ndarray:
        """Smooth a picture (H, W) float32 without history; see `SigmaFilter.smooth`."""
        return self._fine.single(self._wide.single(visibility, penumbra, surface), surface)


class TemporalSigmaFfx:
    """Both filters for a sequence of frames (height, width); the second has the history.

    Args:
        reach: see `SigmaFilter`. sigma: see `FfxFilter`.
    """

    def __init__(self, height: int, width: int, reach: float = REACH, sigma: float = SIGMA):
        self._wide = SigmaFilter(height, width, reach, alone=False)
        self._fine = TemporalFfx(height, width, sigma)

    def next_frame(
        self,
        visibility: np.ndarray,
        penumbra: np.ndarray,
        surface: Surface,
        was: np.ndarray | None = None,
    ) -> np.ndarray:
        """The next frame's picture, (H, W) float32; see `TemporalSigma.next_frame`."""
        wide = self._wide.single(visibility, penumbra, surface)
        return self._fine.next_frame(wide, surface, was)

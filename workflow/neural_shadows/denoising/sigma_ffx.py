"""The SIGMA-like filter, then the FFX-like one for remaining noise."""

from typing import Any

import numpy as np

from neural_shadows.denoising.ffx import CLAMP, PASSES, SHARE, SIGMA, FfxTrials, TemporalFfx
from neural_shadows.denoising.sigma import REACH, SigmaFilter
from neural_shadows.rendering.reprojection import Reprojection
from neural_shadows.rendering.surface import Surface


class SigmaFfxTrials:
    """Both filters for pictures (height, width), one after the other, by any constants.

    While pictures and reach are the same the first runs once: 18 settings take two thirds of their time
    one by one.
    """

    def __init__(self, height: int, width: int):
        self._wide = SigmaFilter(height, width, alone=False)
        self._fine = FfxTrials(height, width)
        self._of: tuple[Any, ...] = ()
        self._picture: np.ndarray | None = None  # of the first filter

    def single(
        self,
        visibility: np.ndarray,
        penumbra: np.ndarray,
        surface: Surface,
        *,
        reach: float = REACH,
        sigma: float = SIGMA,
        passes: float = PASSES,
    ) -> np.ndarray:
        """Smooth a picture (H, W) float32, not to be written to; see `SigmaFilter.smooth`.

        Args:
            reach: see `SigmaFilter`. sigma, passes: see `TemporalFfx`.
        """
        of = visibility, penumbra, surface, reach
        if len(self._of) < len(of) or any(a is not b for a, b in zip(of, self._of)):
            self._picture = self._wide.single(visibility, penumbra, surface, reach=reach)
            self._of = of
        return self._fine.single(self._picture, surface, sigma=sigma, passes=passes)


class TemporalSigmaFfx:
    """Both filters for a sequence of frames (height, width); the second has the history.

    Args:
        reach: see `SigmaFilter`. sigma, passes, share, clamp: see `TemporalFfx`.
    """

    def __init__(
        self,
        height: int,
        width: int,
        reach: float = REACH,
        sigma: float = SIGMA,
        passes: float = PASSES,
        share: float = SHARE,
        clamp: float = CLAMP,
    ):
        self._wide = SigmaFilter(height, width, reach, alone=False)
        self._fine = TemporalFfx(height, width, sigma, passes, share, clamp)

    def next_frame(
        self,
        visibility: np.ndarray,
        penumbra: np.ndarray,
        surface: Surface,
        back: Reprojection | None = None,
    ) -> np.ndarray:
        """The next frame's picture, (H, W) float32; see `TemporalSigma.next_frame`."""
        # With taps turned from frame to frame, as in `TemporalSigma`, errors and flicker were the same to 0.4 %:
        # one and four rays, a moving camera and a moving light.
        wide = self._wide.single(visibility, penumbra, surface)
        return self._fine.next_frame(wide, surface, back)

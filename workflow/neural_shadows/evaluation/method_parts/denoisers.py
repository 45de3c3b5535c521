"""Denoisers of visibility images from few rays a pixel."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, lru_cache, partial
from typing import Any

import numpy as np

from neural_shadows.denoising.ffx import FfxTrials, TemporalFfx
from neural_shadows.denoising.oidn import ANY_RANGE, open_image_denoise
from neural_shadows.denoising.sigma import SigmaFilter, TemporalSigma
from neural_shadows.denoising.sigma_ffx import SigmaFfxTrials, TemporalSigmaFfx
from neural_shadows.denoising.svgf import SvgfTrials
from neural_shadows.denoising.temporal import TemporalFilter
from neural_shadows.frames.ray_tracing import ray_traced, ray_traced_penumbrae
from neural_shadows.frames.soft_frame import SoftFrame
from neural_shadows.rendering.reprojection import Reprojection
from neural_shadows.rendering.surface import Surface


@dataclass(frozen=True)
class Denoiser:
    """A denoiser on one thread.

    Attributes:
        single: of pictures (height, width) float32, the surface and the constants, the smooth
            picture. The inputs are the visibility by rays and, if `distances`, the penumbrae's radii of
            `ray_traced_penumbrae`; lit, and −1, where there is no surface.
        temporal: of a height, a width and the constants, a filter of consecutive frames, if it
            has a history: `next_frame` of the pictures, the surface, and its reprojection.
    """

    single: Callable[..., np.ndarray]
    temporal: Callable[..., Any] | None = None
    distances: bool = False

    def pictures(self, frame: SoftFrame, radius: float, samples: int) -> tuple[np.ndarray, ...]:
        """Images of a frame's rays, for the filter; the same for all of its constants."""
        key = radius, samples, self.distances
        if key not in frame.kept:
            frame.kept.clear()
            frame.kept[key] = self._traced(frame, radius, samples)
        return frame.kept[key]

    def _traced(self, frame: SoftFrame, radius: float, samples: int) -> tuple[np.ndarray, ...]:
        surface = frame.surface
        if not self.distances or radius == 0:
            visibility = surface.image(ray_traced(frame, radius, samples=samples, even=True), 1.0)
            penumbra = np.where(visibility < 1, np.float32(0), np.float32(-1))  # blocked; free
            return (visibility, penumbra)[: 1 + self.distances]
        visibility, penumbra = ray_traced_penumbrae(frame, radius, samples=samples, even=True)
        return surface.image(visibility, 1.0), surface.image(penumbra, -1.0)


def denoised(
    frame: SoftFrame, radius: float, *, samples: int, denoiser: str, **constants: float
) -> np.ndarray:
    """Rays of one frame, then a denoiser: (n,) float32.

    Args:
        radius: of the light, in the scene's unit. A point's shadow has no noise, but steps that the target does
            not have: filters smooth it, too.
        samples: rays of each pixel. denoiser: of `BY_KEY`.

    Raises:
        InputError: the denoiser's package is not installed.
    """
    pictures = BY_KEY[denoiser].pictures(frame, radius, samples)
    smooth = BY_KEY[denoiser].single(*pictures, frame.surface, **constants)
    return smooth.ravel()[frame.surface.pixel]


def sequence_denoiser(
    radius: float, *, samples: int, denoiser: str, **constants: float
) -> Callable[[SoftFrame, Reprojection | None], np.ndarray]:
    """Rays of consecutive frames, then a denoiser's temporal filter.

    Args:
        radius, samples, denoiser: see `denoised`.

    Returns:
        Of the next frame, of a larger number, and its reprojection to the one before, None at first:
        visibility (n,) float32.
    """
    kind = BY_KEY[denoiser]
    temporal = cache(partial(kind.temporal, **constants))

    def step(frame: SoftFrame, back: Reprojection | None) -> np.ndarray:
        surface = frame.surface
        pictures = kind.pictures(frame, radius, samples)
        filter_ = temporal(surface.height, surface.width)
        return filter_.next_frame(*pictures, surface, back).ravel()[surface.pixel]

    return step


def _kept(kind: type) -> Callable:
    """A `Denoiser`'s `single` by one object for all constants, which share what they can.

    The last is kept: of a million pixels 50 MB, and the frames of a set have one size.
    """
    cached = lru_cache(maxsize=1)(kind)

    def single(*pictures_and_surface, **constants: float) -> np.ndarray:
        filter_ = cached(*pictures_and_surface[0].shape)
        return filter_.single(*pictures_and_surface, **constants)

    return single


def _oidn(
    picture: np.ndarray, surface: Surface, *, quality: str, light: float = ANY_RANGE
) -> np.ndarray:
    guides = surface.image(surface.n), surface.depth_image()
    return open_image_denoise(picture, *guides, quality=quality, light=light)


BY_KEY = {
    "svgf": Denoiser(_kept(SvgfTrials), TemporalFilter),
    "ffx": Denoiser(_kept(FfxTrials), TemporalFfx),
    "sigma": Denoiser(_kept(SigmaFilter), TemporalSigma, distances=True),
    "sigma_ffx": Denoiser(_kept(SigmaFfxTrials), TemporalSigmaFfx, distances=True),
    "oidn_fast": Denoiser(partial(_oidn, quality="fast")),
    "oidn": Denoiser(partial(_oidn, quality="high")),
}

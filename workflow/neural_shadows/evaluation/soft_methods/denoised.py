"""Ray tracing with few rays a pixel, and what a denoiser makes of its picture."""

from collections.abc import Iterable, Iterator
from functools import lru_cache, partial
from itertools import repeat

import numpy as np

from neural_shadows.denoising.oidn import open_image_denoise
from neural_shadows.denoising.svgf import SIGMA_LUMINANCE, SvgfFilter, svgf_like
from neural_shadows.denoising.temporal import TemporalFilter
from neural_shadows.evaluation.soft_methods.ray_traced import ray_traced
from neural_shadows.evaluation.soft_methods.soft_method import SoftMethod
from neural_shadows.frames.soft_frame import SoftFrame


def oidn_denoised(
    frame: SoftFrame, radius: float, *, samples: int, quality: str = "high", clean: float = 0
) -> np.ndarray:
    """Rays, then Open Image Denoise on one thread: (n,) float32.

    Args:
        radius: of the light, in the scene's unit; a point's shadow has no noise and stays as it is.
        samples: rays of each pixel. quality, clean: see `open_image_denoise`.

    Raises:
        InputError: the package is not installed.
    """
    rays = ray_traced(frame, radius, samples=samples)
    if radius == 0:
        return rays
    surface = frame.surface
    picture = surface.image(rays, 1.0)
    normal = surface.image(surface.n)
    found = open_image_denoise(picture, normal, quality=quality, clean=bool(clean))
    return found.ravel()[surface.pixel]


def svgf_denoised(
    frame: SoftFrame, radius: float, *, samples: int, sigma_luminance: float = SIGMA_LUMINANCE
) -> np.ndarray:
    """Rays, then the SVGF-like filter of one frame: (n,) float32, on one thread.

    Args:
        radius: of the light, in the scene's unit; a point's shadow has no noise and stays as it is.
        samples: rays of each pixel. sigma_luminance: see `SvgfFilter`.
    """
    rays = ray_traced(frame, radius, samples=samples)
    if radius == 0:
        return rays
    surface = frame.surface
    picture, normal = surface.image(rays, 1.0), surface.image(surface.n)
    filter_ = _filter(*picture.shape, sigma_luminance)
    return svgf_like(filter_, picture, surface.depth_image(), normal).ravel()[surface.pixel]


def svgf_sequence(
    frames: Iterable[SoftFrame],
    radius: float,
    *,
    samples: int,
    sigma_luminance: float = SIGMA_LUMINANCE,
    was: Iterable[np.ndarray | None] | None = None,
) -> Iterator[np.ndarray]:
    """Rays, then the SVGF-like filter with its temporal part, of each frame in turn: (n,) float32.

    Args:
        radius, samples, sigma_luminance: see `svgf_denoised`.
        frames: whose numbers grow. was: of each, where its points were in the one before, (n, 3), if
            anything moved.
    """
    past = repeat(None) if was is None else was
    filter_ = None
    for frame, points in zip(frames, past):
        rays = ray_traced(frame, radius, samples=samples)
        surface = frame.surface
        if radius > 0:
            filter_ = filter_ or TemporalFilter(surface.height, surface.width, sigma_luminance)
            picture = filter_.next_frame(surface.image(rays, 1.0), surface, points)
            rays = picture.ravel()[surface.pixel]
        yield rays


# Only the last is kept: 50 MB for a million pixels, and the frames of a set have one size.
_filter = lru_cache(maxsize=1)(SvgfFilter)


_RAYS = (1, 4, 16, 30)
_TRIED = {"sigma_luminance": (2.0, 4.0, 8.0)}
_BY_RAYS = {"texel_floats": 0, "by_rays": True}


def _smoothed(count: int) -> SoftMethod:
    answer, sequence = (partial(one, samples=count) for one in (svgf_denoised, svgf_sequence))
    return SoftMethod(answer, _TRIED, sequence=sequence, **_BY_RAYS)


METHODS = {
    **{f"rt_{count}_svgf": _smoothed(count) for count in _RAYS},
    **{
        f"rt_{count}_oidn": SoftMethod(partial(oidn_denoised, samples=count), **_BY_RAYS)
        for count in _RAYS
    },
}

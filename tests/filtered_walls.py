"""Pictures of visibility on walls across the view, and the filters that smooth them."""

import numpy as np

from neural_shadows.denoising.ffx import PASSES as FFX_PASSES
from neural_shadows.denoising.ffx import FfxFilter
from neural_shadows.denoising.sigma import SigmaFilter
from neural_shadows.denoising.svgf import PASSES as SVGF_PASSES
from neural_shadows.denoising.svgf import SvgfFilter
from neural_shadows.denoising.trials import smooth

HEIGHT, WIDTH = 40, 56
COLUMNS = np.broadcast_to(np.arange(WIDTH), (HEIGHT, WIDTH))
RIGHT = COLUMNS >= 30
PIXEL = 0.01  # of a wall's points
PENUMBRA = 12 * PIXEL


def wall(depth=2.0, normal=(0, 0, 1)):
    """Guides of a surface across the view."""
    normals = np.empty((HEIGHT, WIDTH, 3), np.float32)
    normals[:] = normal
    return np.full((HEIGHT, WIDTH), depth, np.float32), normals


def two_walls(edge):
    """Guides that have one edge: where RIGHT begins."""
    (depth, normal), (depth_, normal_) = (
        wall(),
        wall(*{"depth": (3.0,), "normal": (2, (1, 0, 0))}[edge]),
    )
    return np.where(RIGHT, depth_, depth), np.where(RIGHT[..., None], normal_, normal)


def svgf(visibility, depth, normal):
    filter_ = SvgfFilter(*depth.shape)
    filter_.see(depth, normal)
    return smooth(filter_, visibility, filter_.noise(visibility), SVGF_PASSES)[1]


def ffx(visibility, depth, normal):
    filter_ = FfxFilter(*depth.shape)
    filter_.see(depth, normal)
    return smooth(filter_, visibility, filter_.noise(visibility), FFX_PASSES)[1]


def seen_by_sigma(filter_, depth, normal):
    """Give the filter a wall that a far camera sees."""
    rows, columns = np.mgrid[: depth.shape[0], : depth.shape[1]] * PIXEL
    place = np.stack([columns, rows, depth], axis=2).astype(np.float32)
    filter_.see(place, normal, np.where(depth > 0, np.float32(PIXEL), np.float32(0)))
    return filter_


def sigma(visibility, depth, normal):
    penumbra = np.where(visibility < 1, np.float32(PENUMBRA), np.float32(-1))
    return seen_by_sigma(SigmaFilter(*depth.shape), depth, normal).smooth(visibility, penumbra)


FILTERS = {"svgf": svgf, "ffx": ffx, "sigma": sigma}


def denoise(key, visibility, depth, normal):
    return FILTERS[key](np.float32(visibility), depth, normal)

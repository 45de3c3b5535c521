"""A depth-aware screen-space filter (Datta et al. 2022, 4).

The paper gives no constants: cross-bilateral over 5 × 5 pixels, guided by depths and normals.
"""

import numpy as np
from numba import njit

from neural_shadows.denoising.decay import decayed
from neural_shadows.rendering.surface import Surface

_REACH = 2  # pixels to each side
_SIGMA_DEPTH = np.float32(0.01)  # of a pixel's own depth
_LEAST = np.float32(1e-12)


def depth_aware(surface: Surface, visibility: np.ndarray, sigma: float) -> np.ndarray:
    """Filter visibilities (n,) over near pixels of similar depth and normal: float32.

    Pixels without a surface do not count.

    Args:
        sigma: standard deviation of the weights over distance, in pixels.
    """
    guides = np.empty((4, surface.height, surface.width), np.float32)
    guides[0] = surface.depth_image()
    guides[1:] = np.moveaxis(surface.image(surface.n), 2, 0)
    across = np.square(np.arange(_REACH + 1) / sigma) / 2
    taps = np.exp(-np.add.outer(across, across)).astype(np.float32)
    filtered = np.zeros_like(guides[0])
    _filter(guides, surface.image(visibility), taps, filtered)
    return filtered.ravel()[surface.pixel]


@njit(cache=True, nogil=True, fastmath=True, error_model="numpy")
def _filter(guides, visibility, taps, filtered):
    height, width = visibility.shape
    total = np.empty(width, np.float32)
    for y in range(height):
        for x in range(width):
            total[x] = _LEAST
        for v in range(max(y - _REACH, 0), min(y + _REACH + 1, height)):
            for along in range(-_REACH, _REACH + 1):
                x, last = max(0, -along), min(width, width - along)
                _add_tap(
                    guides[:, y, x:last],
                    guides[:, v, x + along : last + along],
                    visibility[v, x + along :],
                    taps[abs(v - y), abs(along)],
                    total[x:],
                    filtered[y, x:],
                )
        for x in range(width):
            filtered[y, x] /= total[x]


@njit(cache=True, nogil=True, fastmath=True, error_model="numpy")
def _add_tap(guide, tap_guide, visibility, part, total, filtered):
    """Add a run of taps weighted part · exp(−(Δz / (σ_z z))² / 2) · max(0, n·n')⁸."""
    z, nx, ny, nz = guide[0], guide[1], guide[2], guide[3]
    z_, nx_, ny_, nz_ = tap_guide[0], tap_guide[1], tap_guide[2], tap_guide[3]
    none, half, tiny = np.float32(0), np.float32(0.5), np.float32(1e-12)
    for i in range(len(z)):
        off = (z_[i] - z[i]) / (_SIGMA_DEPTH * z[i] + tiny)
        cosine = max(none, nx[i] * nx_[i] + ny[i] * ny_[i] + nz[i] * nz_[i])
        cosine *= cosine
        cosine *= cosine
        weight = part * decayed(half * off * off) * cosine * cosine
        total[i] += weight
        filtered[i] += weight * visibility[i]

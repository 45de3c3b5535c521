"""Kernels of the SVGF-like filter: edge-stopping weights and means.

Section numbers are those of Schied et al. 2017. Loops go along rows, one tap of the kernel at a
time, so that weights are vectorised.
"""

import numpy as np
from numba import njit

from neural_shadows.denoising.decay import decayed

# σ_z, in slopes of depth: 1 in print (4.4), where it filters colours. With 4, errors on validation frames of `frames` were 13 to
# 29 % less of one ray and 9 to 20 % of four; with 16 no less than that.
SIGMA_DEPTH = 4.0
SIGMA_NORMAL = 128  # σ_n: power of the normals' cosine (4.4)
_REACH = 3  # variance is that of 7 × 7 pixels (4.2)
_B3 = np.array([3 / 8, 1 / 4, 1 / 16], np.float32)  # the cubic B-spline's taps, from its middle
_FLAT = np.float32(1e-4)  # tolerance on a surface without slope, in shares of depth
_LEAST = np.float32(1e-6)  # least standard deviation
_SQUARINGS = int(np.log2(SIGMA_NORMAL))


@njit(cache=True, nogil=True)
def _slope(before, depth, after):
    """The smaller difference of depths in a row, 0 for none."""
    if before <= 0 and after <= 0:
        return np.float32(0)
    if before <= 0:
        return after - depth
    if after <= 0 or abs(depth - before) < abs(after - depth):
        return depth - before
    return after - depth


@njit(cache=True, nogil=True)
def fill_slopes(depth, along, down):
    """Change of depth per pixel, to the right and downwards."""
    height, width = depth.shape
    none = np.float32(0)
    for y in range(height):
        for x in range(width):
            own = depth[y, x]
            left = depth[y, x - 1] if x > 0 else none
            right = depth[y, x + 1] if x + 1 < width else none
            above = depth[y - 1, x] if y > 0 else none
            below = depth[y + 1, x] if y + 1 < height else none
            along[y, x] = _slope(left, own, right)
            down[y, x] = _slope(above, own, below)


@njit(cache=True, nogil=True, fastmath=True, error_model="numpy")
def _weigh(guides, light, sharpness, y, x, v, u, share, weights):
    """Weights of a row's pixels (v, u …) for those of (y, x …).

    share · exp(−|Δz| / (σ_z |∇z·d| + ε) − |Δl| / (σ_l σ + ε)) · max(0, n·n')^σ_n (4.4).
    """
    n = len(weights)
    guide, tap_guide = guides[:, y, x : x + n], guides[:, v, u : u + n]
    z, nx, ny, nz, along, down = guide[0], guide[1], guide[2], guide[3], guide[4], guide[5]
    z_, nx_, ny_, nz_ = tap_guide[0], tap_guide[1], tap_guide[2], tap_guide[3]
    own_light, tap_light, sharp = light[y, x : x + n], light[v, u : u + n], sharpness[y, x:]
    across, below = np.float32(u - x), np.float32(v - y)
    none, tiny = np.float32(0), np.float32(1e-12)
    sigma, aslant = np.float32(SIGMA_DEPTH), np.float32(0.85)
    for i in range(n):
        expected = sigma * abs(along[i] * across + down[i] * below) + _FLAT * z[i] + tiny
        t = abs(z[i] - z_[i]) / expected + abs(own_light[i] - tap_light[i]) * sharp[i]
        cosine = nx[i] * nx_[i] + ny[i] * ny_[i] + nz[i] * nz_[i]
        cosine = none if cosine < aslant else cosine
        for _ in range(_SQUARINGS):
            cosine *= cosine
        weights[i] = share * decayed(t) * cosine


@njit(cache=True, nogil=True, fastmath=True, error_model="numpy")
def fill_moments(guides, mean, square, row, total, first, second):
    """Means of two pictures over 7 × 7 pixels, weighted without luminance."""
    height, width = mean.shape
    flat = np.zeros((height, width), np.float32)
    for y in range(height):
        for x in range(width):
            total[y, x], first[y, x], second[y, x] = 1, mean[y, x], square[y, x]
    for y in range(height):
        for v in range(max(0, y - _REACH), min(height, y + _REACH + 1)):
            for along in range(-_REACH, _REACH + 1):
                x, u, n = max(0, -along), max(0, along), width - abs(along)
                if n <= 0 or (v == y and along == 0):
                    continue
                weights = row[:n]
                _weigh(guides, mean, flat, y, x, v, u, np.float32(1), weights)
                for i in range(n):
                    total[y, x + i] += weights[i]
                    first[y, x + i] += weights[i] * mean[v, u + i]
                    second[y, x + i] += weights[i] * square[v, u + i]
        for x in range(width):
            first[y, x] /= total[y, x]
            second[y, x] /= total[y, x]


@njit(cache=True, nogil=True, fastmath=True, error_model="numpy")
def fill_sharpness(spread, sigma, sharpness):
    """1 / (σ_l · √(variance) + ε), the variance smoothed by a 3 × 3 Gaussian (4.4)."""
    height, width = spread.shape
    for y in range(height):
        above, below = max(0, y - 1), min(height - 1, y + 1)
        for x in range(width):
            left, right = max(0, x - 1), min(width - 1, x + 1)
            corners = (spread[above, left] + spread[above, right] + spread[below, left]) + spread[
                below, right
            ]
            sides = spread[above, x] + spread[below, x] + spread[y, left] + spread[y, right]
            smooth = (corners + 2 * sides + 4 * spread[y, x]) / 16
            sharpness[y, x] = 1 / (sigma * np.sqrt(smooth) + _LEAST)


@njit(cache=True, nogil=True, fastmath=True, error_model="numpy")
def fill_next(guides, light, spread, sharpness, step, row, total, next_light, next_spread):
    """One pass: weighted means, with squared weights for variances (4.3)."""
    height, width = light.shape
    for y in range(height):
        middle = _B3[0] * _B3[0]
        for x in range(width):
            total[y, x] = middle
            next_light[y, x] = middle * light[y, x]
            next_spread[y, x] = middle * middle * spread[y, x]
        for below in range(-2, 3):
            v = y + below * step
            if v < 0 or v >= height:
                continue
            for across in range(-2, 3):
                along = across * step
                n = width - abs(along)
                if n <= 0 or (below == 0 and across == 0):
                    continue
                x, u, weights = max(0, -along), max(0, along), row[:n]
                share = _B3[abs(below)] * _B3[abs(across)]
                _weigh(guides, light, sharpness, y, x, v, u, share, weights)
                for i in range(n):
                    total[y, x + i] += weights[i]
                    next_light[y, x + i] += weights[i] * light[v, u + i]
                    next_spread[y, x + i] += weights[i] * weights[i] * spread[v, u + i]
        for x in range(width):
            next_light[y, x] /= total[y, x]
            next_spread[y, x] /= total[y, x] * total[y, x]

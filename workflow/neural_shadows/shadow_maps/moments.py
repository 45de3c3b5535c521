"""Shadows from filtered powers of depth: variance and moment shadow maps.

A map of moments of depth may be blurred before the look-up; the moments bound a receiver's shadow.

Donnelly and Lauritzen 2006 (variance), Lauritzen and McCool 2008 (exponential variance), Peters and
Klein 2015 (four moments, "Hamburger"). Depths are in [0, 1], 0 nearest to the light; all functions
give visibilities in [0, 1], float32.
"""

import numpy as np
from numba import njit

LEAST_VARIANCE = 1e-6
# Towards (½, ½, ½, ½), for moments of 32 bits. Of 16 they need 3e-5, which here doubles the light that
# leaks into the dark of windows without an area (gallery 1.30 % for 0.66, hall 1.17 for 0.67).
MOMENT_BIAS = 3e-7
# Lauritzen's constants of float32 maps, 40 and 5, are for the scene's range of depths, of which ours is some three
# times: so 9 × 9 texels erred 3 to 8 % less (validation frames of `windows`, three lights).
POSITIVE, NEGATIVE = 120.0, 15.0


def powers(depth: np.ndarray, count: int) -> np.ndarray:
    """The first `count` powers of depths (…): (…, count) float64."""
    moments = np.empty((*np.shape(depth), count))
    moments[..., 0] = depth
    for k in range(1, count):
        np.multiply(moments[..., k - 1], moments[..., 0], out=moments[..., k])
    return moments


def blurred(moments: np.ndarray, kernel: np.ndarray) -> np.ndarray:
    """Filter a map (H, W, moments) by k weights along rows and columns.

    Args:
        kernel: k weights, k odd.

    Returns:
        (H − k + 1, W − k + 1, moments) float64: only where the kernel is within the map.
    """
    height, width, count = moments.shape
    margin = len(kernel) - 1
    filtered = np.empty((height - margin, width - margin, count))
    values = np.ascontiguousarray(moments, np.float64).ravel()
    _fill_blurred(values, width * count, kernel, count, filtered.reshape(height - margin, -1))
    return filtered


@njit(cache=True, nogil=True)
def _fill_blurred(values, width, kernel, count, filtered):
    """Filter rows of a width, down the columns and along themselves."""
    line = np.empty(width)
    for i in range(len(filtered)):
        _fill_sums(values[i * width :], width, kernel, line)
        _fill_sums(line, count, kernel, filtered[i])


@njit(cache=True, nogil=True, fastmath={"contract"})
def _fill_sums(values, step, kernel, sums):
    """Weighted sums of values (…) a step apart; odd number of weights."""
    weight = kernel[0]
    for j in range(len(sums)):
        sums[j] = weight * values[j]
    # Two weights at once: half as many sums are written and read again.
    for k in range(1, len(kernel), 2):
        a, b = kernel[k], kernel[k + 1]
        first, second = values[k * step :], values[(k + 1) * step :]
        for j in range(len(sums)):
            sums[j] += a * first[j] + b * second[j]


def box(size: int) -> np.ndarray:
    """The kernel of a mean over `size` texels."""
    return np.full(size, 1 / size)


def gaussian(size: int, sigma: float) -> np.ndarray:
    """A Gaussian over `size` texels; sigma in texels."""
    place = np.arange(size) - (size - 1) / 2
    weights = np.exp(-0.5 * (place / sigma) ** 2)
    return weights / weights.sum()


def variance_visibility(moments: np.ndarray, depth: np.ndarray) -> np.ndarray:
    """Chebyshev's bound from two moments (n, 2), of receivers at depths (n,)."""
    mean = moments[:, 0]
    variance = np.maximum(moments[:, 1] - mean**2, LEAST_VARIANCE)
    behind = np.maximum(depth - mean, 0)
    return (variance / (variance + behind**2)).astype(np.float32)


def warped(depth: np.ndarray) -> np.ndarray:
    """Two exponentials of depth and their squares (EVSM), (…, 4) float64."""
    place = 2 * np.asarray(depth, np.float64) - 1
    near, far = np.exp(POSITIVE * place), -np.exp(-NEGATIVE * place)
    return np.stack([near, near**2, far, far**2], axis=-1)


def exponential_visibility(moments: np.ndarray, depth: np.ndarray) -> np.ndarray:
    """The lesser of the bounds of both exponentials (n, 4), of receivers at depths (n,)."""
    goal = warped(depth)
    bounds = []
    for k, constant in ((0, POSITIVE), (2, NEGATIVE)):
        mean, behind = moments[:, k], np.maximum(goal[:, k] - moments[:, k], 0)
        # Change of the warped depth, of −1 to 1, for 5e-5 of the map's range.
        least = (1e-4 * constant * goal[:, k]) ** 2
        variance = np.maximum(moments[:, k + 1] - mean**2, least)
        bounds.append(variance / (variance + behind**2))
    return np.minimum(*bounds).astype(np.float32)


@njit(cache=True, nogil=True, error_model="numpy")
def hamburger_visibility(moments, depth):
    """The least shadow by four moments (n, 4), at depths (n,).

    By the distribution of three depths, one the receiver's, with these moments.
    """
    visibility = np.empty(len(depth), np.float32)
    for i in range(len(depth)):
        visibility[i] = 1 - _hidden(moments[i], np.float64(depth[i]))[0]
    return visibility


@njit(cache=True, nogil=True, error_model="numpy")
def hamburger_blockers(moments, depth, least):
    """Mean depth of what is before depths (n,), by four moments (n, 4): (n,) float64.

    By the same three depths (Peters et al. 2017, 4.1). Where hardly more than a share `least` is before the
    receiver, a mean of small numbers, it goes to the receiver's depth.
    """
    blockers = np.empty(len(depth))
    for i in range(len(depth)):
        z = np.float64(depth[i])
        shadow, total = _hidden(moments[i], z)
        blockers[i] = (least * z + total) / (least + shadow)
    return blockers


@njit(cache=True, nogil=True, error_model="numpy")
def _hidden(moments, z):
    """The share before z of the distribution of three depths, and its sum of depths."""
    b1, b2, b3, b4 = (
        (1 - MOMENT_BIAS) * np.float64(moments[0]) + MOMENT_BIAS * 0.5,
        (1 - MOMENT_BIAS) * np.float64(moments[1]) + MOMENT_BIAS * 0.5,
        (1 - MOMENT_BIAS) * np.float64(moments[2]) + MOMENT_BIAS * 0.5,
        (1 - MOMENT_BIAS) * np.float64(moments[3]) + MOMENT_BIAS * 0.5,
    )
    # [[1, b1, b2], [b1, b2, b3], [b2, b3, b4]] c = (1, z, z²) by its LDLᵀ.
    l32d22 = b3 - b1 * b2
    d22 = b2 - b1 * b1
    l32 = l32d22 / d22
    # 0 if all depths are 0 or 1, as in empty texels.
    d33 = max(b4 - b2 * b2 - l32d22 * l32, 1e-14)
    c1, c2 = z - b1, z * z - b2
    c2 = (c2 - l32 * c1) / d33
    if abs(c2) < 1e-9:  # two depths, one the receiver's, suffice: the third is far away
        c2 = 1e-9
    c1 = c1 / d22 - l32 * c2
    c0 = 1 - c1 * b1 - c2 * b2
    # The other two depths: roots of c0 + c1 t + c2 t², the one by the other lest digits cancel.
    middle, product = -c1 / (2 * c2), c0 / c2
    half = np.sqrt(max(middle * middle - product, 0.0))
    root = middle + half if middle >= 0 else middle - half
    other = product / root if root != 0 else 0.0
    near, far = min(root, other), max(root, other)
    if z <= near:
        return 0.0, 0.0
    if z <= far:
        shadow = (z * far - b1 * (z + far) + b2) / ((far - near) * (z - near))
        shadow = min(max(shadow, 0.0), 1.0)
        return shadow, shadow * near
    lit = (near * far - b1 * (near + far) + b2) / ((z - near) * (z - far))
    lit = min(max(lit, 0.0), 1.0)
    return 1 - lit, b1 - lit * z

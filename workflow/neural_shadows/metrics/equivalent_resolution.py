"""The shadow map as wrong as a method. A method's error in texels."""

from collections.abc import Sequence

import numpy as np


def equivalent_resolution(
    sizes: Sequence[int], errors: Sequence[float], error: float
) -> float | None:
    """Side in texels of the smallest map with this error. None outside those measured.

    Both the size and the error are interpolated in their logarithms: maps halve their error at
    about each doubling. For PSNR give `mse_of` it, so that it is linear in dB; LPIPS and 1 − SSIM
    as they are. The thesis's network on the dragon is worth 386² by LPIPS and 191² by PSNR
    (table 4.3).

    Args:
        sizes: of the maps, in any order.
        errors: of each map, > 0.
        error: the method's, > 0.
    """
    order = np.argsort(sizes)
    x, y = np.log(np.asarray(sizes, float)[order]), np.log(np.asarray(errors, float)[order])
    log_error = np.log(error)
    for i in range(len(x) - 1):
        if min(y[i], y[i + 1]) <= log_error <= max(y[i], y[i + 1]):
            fraction = (log_error - y[i]) / (y[i + 1] - y[i]) if y[i] != y[i + 1] else 0.0
            return float(np.exp(x[i] + fraction * (x[i + 1] - x[i])))
    return None

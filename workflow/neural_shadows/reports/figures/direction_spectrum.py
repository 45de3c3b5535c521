"""How evenly directions are spread, by spatial frequency on the sphere."""

import numpy as np
from numpy.polynomial.legendre import legvander


def angular_power_spectrum(directions: np.ndarray, degrees: int) -> np.ndarray:
    """Power of a point set by spherical-harmonic degree; 1 is expected of independent directions.

    S_l = 4π / (N (2l + 1)) Σ_m |Σ_i Y_lm(x_i)|², which by the addition theorem is
    1/N Σ_ij P_l(x_i · x_j). A Poisson-disk pattern has little power at low degrees: blue noise.

    Args:
        directions: (N, 3) unit vectors.
        degrees: the largest degree L.

    Returns:
        (L,) S_1 to S_L; S_0 is N for every set.
    """
    x = directions.astype(np.float64)
    # Row by row: all pairs of 1000 directions at 80 degrees would take 320 MB.
    rows = (legvander(x[i + 1 :] @ x[i], degrees).sum(0) for i in range(len(x)))
    return 1 + 2 * sum(rows)[1:] / len(x)

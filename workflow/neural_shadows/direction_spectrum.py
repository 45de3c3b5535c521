"""How evenly directions are spread, by spatial frequency on the sphere."""

import numpy as np
from scipy.special import eval_legendre


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
    i, j = np.triu_indices(len(x), 1)
    cosines = np.einsum("ik,ik->i", x[i], x[j])
    pairs = [eval_legendre(degree, cosines).sum() for degree in range(1, degrees + 1)]
    return 1 + 2 * np.array(pairs) / len(x)

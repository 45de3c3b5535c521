"""A vectorisable exponential."""

import numpy as np
from numba import njit

_RARE = np.float32(20)  # exp(−20) = 2e-9 and less become 0: denormals are slow
_PART = np.float32(1 / 1024)


@njit(cache=True, nogil=True, fastmath=True, error_model="numpy")
def decayed(t):
    """e⁻ᵗ of a float32 t ≥ 0 as (1 − t / 1024)^1024, at most 3e-4 off; 0 above 20."""
    weight = np.float32(0) if t > _RARE else np.float32(1) - t * _PART
    for _ in range(10):
        weight *= weight
    return weight

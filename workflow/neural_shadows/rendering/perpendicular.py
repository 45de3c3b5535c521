"""Two directions across one."""

import numpy as np
from numba import njit

_ONE = np.float32(1)  # so that float32 stays float32; float64 stays float64 with it, too


@njit(cache=True, nogil=True)
def perpendicular(x, y, z):
    """Unit vectors u, v across a unit vector d, with u × v = d, three numbers each.

    T. Duff et al., "Building an orthonormal basis, revisited", JCGT 6(1), 2017: exact to
    rounding for every d, and continuous but for d_z changing its sign.
    """
    sign = _ONE if z >= 0 else -_ONE
    a = -_ONE / (sign + z)
    b = x * y * a
    return (_ONE + sign * x * x * a, sign * b, -sign * x), (b, sign + y * y * a, -y)

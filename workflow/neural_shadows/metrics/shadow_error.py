"""How much of a frame's visibility is wrong, and which way it is wrong."""

from typing import NamedTuple

import numpy as np


class ShadowError(NamedTuple):
    """Means over the surface points; of hard shadows, shares of points that are wrong."""

    shadow_error: float  # both of the others
    false_shadow: float  # darker than the reference
    light_leak: float  # brighter than the reference


def shadow_error(visibility: np.ndarray, reference: np.ndarray) -> ShadowError:
    """Mean difference of visibilities in [0, 1] of a frame's n surface points, each (n,).

    Raises:
        ValueError: there are no points.
    """
    if len(reference) == 0:
        raise ValueError("shadow_error: no pixel shows object or receiver")
    difference = np.subtract(visibility, reference, dtype=np.float64)
    sums = np.abs(difference).sum(), (-difference).clip(0).sum(), difference.clip(0).sum()
    return ShadowError(*(float(total / len(reference)) for total in sums))

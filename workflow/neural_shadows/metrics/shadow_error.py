"""Share of a frame's visibility in error, by direction."""

from typing import NamedTuple

import numpy as np


class ShadowError(NamedTuple):
    """Means over the surface points. Of hard shadows, shares of wrong points."""

    shadow_error: float  # sum of the others
    false_shadow: float  # darker than the reference
    light_leak: float  # brighter than the reference


def shadow_error(visibility: np.ndarray, reference: np.ndarray) -> ShadowError:
    """Mean differences of visibilities in [0, 1]. Of a frame's n surface points, each (n,).

    Raises:
        ValueError: there are no points.
    """
    if len(reference) == 0:
        raise ValueError("shadow_error: no pixel shows object or receiver")
    difference = np.subtract(visibility, reference, dtype=np.float64)
    sums = np.abs(difference).sum(), (-difference).clip(0).sum(), difference.clip(0).sum()
    return ShadowError(*(float(total / len(reference)) for total in sums))

"""Violations of labels' bounds by a network's depth, and errors [5.1]."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

# Of the counts of depths that know nothing of the object, before their names.
RANDOM = "random_"
TOLERANCE = 1e-4  # sphere radii, a tenth of the shading offset: less is rounding


class Violations(NamedTuple):
    """Counts over a frame's sphere rays, one a shading point.

    The thesis says that a violated lower bound always shows, as false shadow, and an upper one
    only where another surface lies between, as a light leak. False shadow can only be where a point
    is lit, and a leak where it is not: how many of the violations are there is counted too, or
    random depths would confirm it, by the share of points that are lit.
    They confirm it even so: a lit point is the first hit itself, or on a ray that misses, so that a
    depth short of the bound nearly always darkens it. `random_depths` are therefore counted as well.
    """

    queries: int
    lower_violations: int  # the depth is before the first hit, or short of a miss's chord
    lit_of_lower: int  # of those, points that are lit
    false_shadow_of_lower: int  # of those, points wrongly in shadow
    upper_violations: int  # it is behind the second hit
    shadowed_of_upper: int  # of those, points in shadow
    light_leak_of_upper: int  # of those, points wrongly lit


def compare_depths(
    t: np.ndarray, t_lb: np.ndarray, t_ub: np.ndarray, lit: np.ndarray, truth: np.ndarray
) -> Violations:
    """Compare depths t (k,) with bounds of the same rays.

    t (k,) has its depth bias, bounds are (k,).

    Args:
        t_lb, t_ub: as `dual_bounds` gives them.
        lit: (k,) bool, the network's visibility of the points; truth: (k,) the reference's.
    """
    lower, upper = t < t_lb - TOLERANCE, t > t_ub + TOLERANCE
    bright, dark = lower & (truth == 1), upper & (truth == 0)
    counted = len(t), lower, bright, bright & ~lit, upper, dark, dark & lit
    return Violations(*(int(np.sum(mask)) for mask in counted))


def random_depths(
    s: np.ndarray, chord: np.ndarray, seed: int | Sequence[int]
) -> tuple[np.ndarray, np.ndarray]:
    """Draw depths uniformly along the chords (k,) of rays, with the answers that follow.

    Args:
        s: (k,) distances from the sphere to the points.

    Returns:
        Depths (k,) float32; lit: (k,) bool, as `ShadowNetwork.points_lit` answers depths.
    """
    t = np.random.default_rng(seed).random(len(chord), np.float32) * chord
    return t, np.minimum(s, chord) <= t

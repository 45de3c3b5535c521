"""Labels of training rays: first and second intersection with the object [3.4.3]."""

import numpy as np
from numba import njit

from neural_shadows.scenes.tracing import Tracer

# Distance behind a hit at which the next trace starts. Embree's float32 hits are off by some
# 2e-7 at a scale of 1, a hundredth of the step; walls and wires are 1e-3 thick and more,
# fifty times the step.
SECOND_HIT_STEP = 2e-5

# A ray meets a triangle once. Where it does so at a flat angle, rounding can leave the moved
# origin still before the triangle; the step is then doubled, this often at most.
_MOST_STEPS = 8

# Rays traced to both hits at once: few enough that the data of the first trace is still in the
# cache for the second (15 % faster than 10,000 rays at once).
_BLOCK = 2048

# Distance outside the unit sphere at which a hit may be, as the vertices of a prepared mesh.
_SPHERE_SLACK = 1e-4

# A vertex on the sphere can be hit at the origin itself, t = 0. It is put one rounding of a
# coordinate behind, so that no label is 0, as in a file never written to.
_LEAST = np.finfo(np.float32).eps


def dual_bounds(
    tracer: Tracer, origins: np.ndarray, directions: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Bounds of the shadow boundary along each ray [3.4.3].

    t_lb and t_ub are the first and the second intersection; t_ub = ∞ where there is but one.
    Where there is none, t_lb is the chord ℓ = −2 o·d and t_ub = ∞. `check_bounds` checks them.

    Two surfaces within `SECOND_HIT_STEP` of each other along the ray count as one.

    Args:
        tracer: the object, in normalised space.
        origins: (n, 3) float32 on the unit sphere.
        directions: (n, 3) or (3,) float32 unit vectors.

    Returns:
        t_lb, t_ub: (n,) float32, distances from the origin.
    """
    directions = np.broadcast_to(directions, origins.shape)
    t_lb = np.empty(len(origins), np.float32)
    t_ub = np.empty(len(origins), np.float32)
    for begin in range(0, len(origins), _BLOCK):
        block = slice(begin, begin + _BLOCK)
        t_lb[block], t_ub[block] = _two_hits(tracer, origins[block], directions[block])
    chord = chord_lengths(origins, directions)
    # |o + t d|² = 1 + t (t − ℓ): hits stay behind the origin and before the chord's end.
    inside = t_lb * (t_lb - chord) <= np.float64(2 * _SPHERE_SLACK)
    t_lb = np.where(inside, np.minimum(np.maximum(t_lb, _LEAST), chord), t_lb)
    return np.where(np.isinf(t_lb), chord, t_lb), t_ub


def check_bounds(
    directions: np.ndarray, origins: np.ndarray, bounds: np.ndarray, *, name: str, first: int = 0
) -> None:
    """Check 0 < t_lb <= ℓ and t_lb <= t_ub for a shard [3.4.3].

    t_lb is then finite; t_ub may be ∞ but not NaN. ℓ needs no
    tolerance: `dual_bounds` ends t_lb with it.

    Args:
        directions: (D, 3), origins: (D, m, 3), bounds: (D, m, 2), all float32.
        name: for the error; first: the index of their first direction.

    Raises:
        RuntimeError: bounds that break these rules.
    """
    for i, direction in enumerate(directions):
        chord = chord_lengths(origins[i], direction)
        t_lb, t_ub = bounds[i].T
        # NaN compares as false.
        valid = (0 < t_lb) & (t_lb <= chord) & (t_lb <= t_ub)
        if not valid.all():
            j = valid.argmin()
            raise RuntimeError(
                f"{name}: ray {j} of direction {first + i} from {origins[i, j].tolist()} along "
                f"{direction.tolist()} has the bounds t_lb = {t_lb[j]}, t_ub = {t_ub[j]} on a chord "
                f"of {chord[j]}, where 0 < t_lb <= min(chord, t_ub) must hold: it does not start on "
                "the unit sphere, the mesh is not inside it, or the file is incomplete"
            )


def _two_hits(tracer, origins, directions):
    """First and second intersection of each ray (n,), ∞ where there is none."""
    first, face = tracer.first_hit(origins, directions)
    second = np.full(len(first), np.inf, np.float32)
    rays = np.flatnonzero(face >= 0)
    step = SECOND_HIT_STEP
    start = first[rays] + step
    for _ in range(_MOST_STEPS):
        t, behind = tracer.first_hit(*_moved(origins, directions, rays, start))
        second[rays] = start + t
        again = np.flatnonzero(behind == face[rays])
        if len(again) == 0:
            break
        step *= 2
        rays = rays[again]
        start = second[rays] + step
    return first, second


@njit(cache=True, nogil=True)
def _moved(origins, directions, rays, along):
    """Origins of chosen rays, moved along them, and their directions: (n, 3) float32 each.

    Computed in float64, as by numpy, whose arrays in between took 4 % of a shard's time.
    """
    moved = np.empty((len(rays), 3), np.float32)
    chosen = np.empty((len(rays), 3), np.float32)
    for i in range(len(rays)):
        for axis in range(3):
            d = directions[rays[i], axis]
            chosen[i, axis] = d
            moved[i, axis] = np.float64(origins[rays[i], axis]) + np.float64(along[i]) * d
    return moved, chosen


def chord_lengths(origins: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """Lengths ℓ = −2 o·d of rays' chords of the unit sphere: (n,) float32.

    Origins are (n, 3) and directions (n, 3) or (3,), float32.
    """
    return _chords(origins, np.broadcast_to(directions, origins.shape))


@njit(cache=True, nogil=True)
def _chords(origins, directions):
    chord = np.empty(len(origins), np.float32)
    for i in range(len(origins)):
        # In float64: near the rim o·d is small beside its terms.
        along = 0.0
        for axis in range(3):
            along += np.float64(origins[i, axis]) * np.float64(directions[i, axis])
        chord[i] = -2 * along
    return chord

"""Labels of training rays: first and second intersection with the object [3.4.3]."""

import numpy as np
from numba import njit

from neural_shadows.tracing import Tracer

# How far past a hit the trace for the next one starts. Embree's float32 hits are off by some
# 2e-7 at a scale of 1, a hundredth of the step; walls and wires are 1e-3 thick and more,
# fifty times the step.
SECOND_HIT_STEP = 2e-5

# A ray meets a triangle once. Where it does so at a flat angle, rounding can leave the moved
# origin still before the triangle; the step is then doubled, this often at most.
_MOST_STEPS = 8

# Rays that are traced to both hits before the next ones are: few enough that what the first
# trace read is still in the cache for the second (15 % faster than 10,000 rays at once).
_BLOCK = 2048

# How far outside the unit sphere a hit may be, as the vertices of a prepared mesh.
_SPHERE_SLACK = 1e-4


def dual_bounds(
    tracer: Tracer, origins: np.ndarray, directions: np.ndarray, *, name: str = "rays"
) -> tuple[np.ndarray, np.ndarray]:
    """Bounds of the shadow boundary along each ray [3.4.3].

    t_lb and t_ub are the first and the second intersection; t_ub = ∞ where there is but one.
    Where there is none, t_lb is the chord ℓ = −2 o·d and t_ub = ∞. Always
    0 <= t_lb <= ℓ and t_lb <= t_ub.

    Two surfaces within `SECOND_HIT_STEP` of each other along the ray count as one.

    Args:
        tracer: the object, in normalised space.
        origins: (n, 3) float32 on the unit sphere.
        directions: (n, 3) or (3,) float32 unit vectors.
        name: what the error calls these rays.

    Returns:
        t_lb, t_ub: (n,) float32, distances from the origin.

    Raises:
        RuntimeError: bounds that break these rules, as of rays that do not start on the
            sphere, or of an object that is not in it.
    """
    directions = np.broadcast_to(directions, origins.shape)
    t_lb = np.empty(len(origins), np.float32)
    t_ub = np.empty(len(origins), np.float32)
    for begin in range(0, len(origins), _BLOCK):
        block = slice(begin, begin + _BLOCK)
        t_lb[block], t_ub[block] = _two_hits(tracer, origins[block], directions[block])
    bad = _settle(origins, directions, t_lb, t_ub)
    if bad >= 0:
        raise RuntimeError(
            f"{name}: ray {bad} from {origins[bad]} along {directions[bad]} has the bounds "
            f"[{t_lb[bad]}, {t_ub[bad]}]: it does not start on the unit sphere, or the mesh "
            "is not inside it"
        )
    return t_lb, t_ub


def _two_hits(tracer, origins, directions):
    """First and second intersection of each ray (n,), ∞ where there is none."""
    first, face = tracer.first_hit(origins, directions)
    second = np.full(len(first), np.inf, np.float32)
    rays = np.flatnonzero(face >= 0)
    step = SECOND_HIT_STEP
    start = first[rays] + step
    for _ in range(_MOST_STEPS):
        t, behind = tracer.first_hit(_moved(origins, directions, rays, start), directions[rays])
        second[rays] = start + t
        again = np.flatnonzero(behind == face[rays])
        if len(again) == 0:
            break
        step *= 2
        rays = rays[again]
        start = second[rays] + step
    return first, second


@njit(cache=True, nogil=True)
def chord_lengths(origins, directions):
    """ℓ = −2 o·d of each ray, the length of its chord of the unit sphere: (n,) float32."""
    lengths = np.empty(len(origins), np.float32)
    for i in range(len(origins)):
        lengths[i] = _chord(origins[i], directions[i])
    return lengths


@njit(cache=True, nogil=True)
def _chord(o, d):
    # In float64: near the rim o·d is small beside its terms.
    x, y, z = np.float64(o[0]), np.float64(o[1]), np.float64(o[2])
    return np.float32(-2 * (x * d[0] + y * d[1] + z * d[2]))


@njit(cache=True, nogil=True)
def _moved(origins, directions, rays, distances):
    """Points (n, 3) float32 at these distances along some of the rays."""
    points = np.empty((len(rays), 3), np.float32)
    for i in range(len(rays)):
        for axis in range(3):
            points[i, axis] = (
                origins[rays[i], axis] + np.float64(distances[i]) * directions[rays[i], axis]
            )
    return points


@njit(cache=True, nogil=True)
def _settle(origins, directions, t_lb, t_ub):
    """Set t_lb of misses, keep that of hits to the chord; index of a ray with bad bounds, or −1."""
    bad = -1
    for i in range(len(t_lb)):
        chord = _chord(origins[i], directions[i])
        if np.isinf(t_lb[i]):
            t_lb[i] = chord
        # |o + t d|² = 1 + t (t − ℓ)
        elif t_lb[i] * (t_lb[i] - chord) <= 2 * _SPHERE_SLACK:
            t_lb[i] = min(t_lb[i], chord)
        if not 0 <= t_lb[i] <= min(chord, t_ub[i]):
            bad = i
    return bad

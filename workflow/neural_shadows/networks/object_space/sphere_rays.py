"""Rays from a light to points, entering the unit sphere [3.6.1]."""

from dataclasses import dataclass

import numpy as np
import torch
from numba import njit
from torch import Tensor


@dataclass(frozen=True, eq=False)
class SphereRays:
    """Rays through the sphere, of k of m shading points."""

    index: Tensor  # (k,) int64, into the m points
    origins: Tensor  # (k, 3) float32, entry points o on the unit sphere
    s: Tensor  # (k,) float32, distance from o to p along d = −l, > 0
    chord: Tensor  # (k,) float32, ℓ = −2 o·d in (0, 2]


def sphere_rays(p: Tensor, light: Tensor) -> SphereRays:
    """Rays from the light to points, without culled ones [3.6.1].

    Points p (m, 3) and the unit vector l towards the light (3,) are float32. A point is culled, and
    lit, if its line p + s l misses the sphere or if it lies between light and sphere (s ≤ 0).
    """
    return _in_one_pass(p, light) if p.device.type == "cpu" else _by_tensors(p, light)


def _by_tensors(p: Tensor, light: Tensor) -> SphereRays:
    along = p @ light
    # The part of p across the light instead of |p|² − (p·l)², which would cancel a ground point's
    # digits: at |p| = 20, the ground's rim, the square is 400 times the sphere's.
    across = p - along[:, None] * light
    half_chord_squared = 1 - across.square().sum(1)
    half_chord = half_chord_squared.clamp(min=0).sqrt()
    s = half_chord - along
    index = ((half_chord_squared > 0) & (s > 0)).nonzero().squeeze(1)
    half_chord = half_chord.index_select(0, index)
    return SphereRays(
        index=index,
        origins=across.index_select(0, index) + half_chord[:, None] * light,
        s=s.index_select(0, index),
        chord=2 * half_chord,
    )


def _in_one_pass(p: Tensor, light: Tensor) -> SphereRays:
    """`_by_tensors`, a point at a time: on a CPU 5 ns a point instead of 25."""
    index = np.empty(len(p), np.int64)
    origins = np.empty((len(p), 3), np.float32)
    s, chord = np.empty((2, len(p)), np.float32)
    count = _enter_sphere(p.numpy(), light.numpy(), index, origins, s, chord)
    return SphereRays(*(torch.from_numpy(part[:count]) for part in (index, origins, s, chord)))


@njit(cache=True, nogil=True)
def _enter_sphere(p, light, index, origins, s, chord):
    """Fill in the rays from a light to points p, without culled ones; return their number.

    Args:
        p: (m, 3) float32. light: (3,) float32, unit vector towards the light.
        index: (m,) int64, of each ray's point. origins: (m, 3) float32, entry points on the sphere.
        s, chord: (m,) float32, distances from there to the point, and to the sphere's other side.
    """
    u, v, w = light
    one, count = np.float32(1), 0
    for point in range(len(p)):
        x, y, z = p[point]
        along = x * u + y * v + z * w
        x, y, z = x - along * u, y - along * v, z - along * w
        half_chord_squared = one - (x * x + y * y + z * z)
        if half_chord_squared <= 0:
            continue
        half_chord = np.sqrt(half_chord_squared)
        if half_chord <= along:
            continue
        index[count] = point
        origins[count, 0] = x + half_chord * u
        origins[count, 1] = y + half_chord * v
        origins[count, 2] = z + half_chord * w
        s[count], chord[count] = half_chord - along, 2 * half_chord
        count += 1
    return count

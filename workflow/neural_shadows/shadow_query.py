"""Which points a shadow network calls lit [3.6]."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np
import torch


class DepthQuery(Protocol):
    """What the depth test needs of a network."""

    def depths(self, origins: np.ndarray, d: np.ndarray, dtype: torch.dtype) -> np.ndarray:
        """t_pred of parallel rays, from entry points (k, 3) along d (3,): (k,) float32."""


@dataclass(frozen=True, eq=False)
class SphereRays:
    """The k of m shading points whose line to the light passes the sphere on the light's side."""

    index: np.ndarray  # (k,) int64, into the m points
    origins: np.ndarray  # (k, 3) float32, entry points o on the unit sphere
    s: np.ndarray  # (k,) float32, distance from o to p along d = −l, > 0
    chord: np.ndarray  # (k,) float32, ℓ = −2 o·d in (0, 2]


def sphere_rays(p: np.ndarray, light: np.ndarray) -> SphereRays:
    """Rays from the light to points, entering the unit sphere; the others are culled [3.6.1].

    Args:
        p: (m, 3) float32 points in normalised space.
        light: (3,) unit vector l towards the light.

    A point is culled, and is lit, if its line p + s l misses the sphere or if it lies between
    the light and the sphere (s ≤ 0).
    """
    light = np.asarray(light, np.float32)
    along = p @ light
    # The part of p across the light and not |p|² − (p·l)², which would lose a ground point's
    # digits: at |p| = 20, the ground's rim, the square is 400 times the sphere's.
    across = p - along[:, None] * light
    half_chord_squared = 1 - np.einsum("ij,ij->i", across, across)
    half_chord = np.sqrt(np.maximum(half_chord_squared, 0))
    s = half_chord - along
    index = np.flatnonzero((half_chord_squared > 0) & (s > 0))
    half_chord = half_chord[index]
    return SphereRays(
        index=index,
        origins=across[index] + half_chord[:, None] * light,
        s=s[index],
        chord=2 * half_chord,
    )


def network_lit(
    network: DepthQuery,
    p: np.ndarray,
    light: np.ndarray,
    *,
    dtype: torch.dtype,
    depth_bias: float = 0.0,
) -> np.ndarray:
    """What a network says of each point: lit, (m,) bool [3.6.2].

    shadowed ⟺ min(s, ℓ) > t_pred(o, d) + depth_bias. The clamp of s to the chord ℓ is
    essential: a ray that misses the object is only ever trained to t ≥ ℓ, so that without it
    every receiver behind the sphere would be in shadow.

    Args:
        p: (m, 3) float32 points in normalised space.
        light: (3,) unit vector towards the light.
        depth_bias: in units of the sphere's radius.
    """
    rays = sphere_rays(p, light)
    t_pred = network.depths(rays.origins, -np.asarray(light, np.float32), dtype)
    return lit_points(rays, t_pred, len(p), depth_bias)


def lit_points(rays: SphereRays, t_pred: np.ndarray, count: int, depth_bias: float) -> np.ndarray:
    """The depth test of `network_lit` on depths t_pred (k,) of the rays to `count` points."""
    lit = np.ones(count, bool)
    lit[rays.index] = np.minimum(rays.s, rays.chord) <= t_pred + np.float32(depth_bias)
    return lit

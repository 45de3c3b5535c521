"""Which points a shadow network calls lit [3.6]; all on the device that the network is on."""

from dataclasses import dataclass

import numpy as np
import torch
from torch import Tensor

from neural_shadows.networks.object_space.shadow_network import ShadowNetwork


@dataclass(frozen=True, eq=False)
class SphereRays:
    """The k of m shading points whose line to the light passes the sphere on the light's side."""

    index: Tensor  # (k,) int64, into the m points
    origins: Tensor  # (k, 3) float32, entry points o on the unit sphere
    s: Tensor  # (k,) float32, distance from o to p along d = −l, > 0
    chord: Tensor  # (k,) float32, ℓ = −2 o·d in (0, 2]


def sphere_rays(p: Tensor, light: Tensor) -> SphereRays:
    """Rays from the light to points, entering the unit sphere; the others are culled [3.6.1].

    Points p (m, 3) and the unit vector l towards the light (3,) are float32. A point is culled, and is lit, if its line p + s l misses the sphere or if it lies between
    the light and the sphere (s ≤ 0).
    """
    along = p @ light
    # The part of p across the light and not |p|² − (p·l)², which would lose a ground point's
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


def network_lit(
    network: ShadowNetwork,
    p: Tensor,
    light: Tensor,
    *,
    dtype: torch.dtype,
    depth_bias: float = 0.0,
) -> Tensor:
    """Whether a network says of each point that it is lit, (m,) bool [3.6.2].

    shadowed ⟺ min(s, ℓ) > t_pred(o, d) + depth_bias. The clamp of s to the chord ℓ is
    essential: a ray that misses the object is only ever trained to t ≥ ℓ, so that without it
    every receiver behind the sphere would be in shadow.

    p and light are as of `sphere_rays`, in normalised space and on the network's device; the
    depth bias is in units of the sphere's radius.
    """
    rays = sphere_rays(p, light)
    t_pred = network.depths(rays.origins, -light, dtype)
    return lit_points(rays, t_pred, len(p), depth_bias)


def lit_points(rays: SphereRays, t_pred: Tensor, count: int, depth_bias: float) -> Tensor:
    """The depth test of `network_lit` on depths t_pred (k,) of the rays to `count` points."""
    lit = torch.ones(count, dtype=torch.bool, device=t_pred.device)
    lit[rays.index] = torch.minimum(rays.s, rays.chord) <= t_pred + depth_bias
    return lit


def on_device(points: np.ndarray, light: np.ndarray, device: torch.device) -> tuple[Tensor, Tensor]:
    """Points (m, 3) float32 and a light (3,) as the functions above take them."""
    light = torch.from_numpy(np.asarray(light, np.float32))
    return torch.from_numpy(points).to(device), light.to(device)

"""The loss of answering no shadow at all, which a network must beat to have learned anything."""

import numpy as np
import torch

from neural_shadows.networks.object_space.dead_zone_loss import DeadZone
from neural_shadows.networks.object_space.shadow_network import LabelledBatch, chords
from neural_shadows.rays.ray_set import RaySet

# As many in all; the mean of so many differs from that of all rays by about a thousandth.
RAYS = 1 << 20
_CHUNK = 1 << 16


def no_shadow_loss(rays: RaySet, dead_zone: DeadZone) -> float:
    """Mean dead-zone loss of t = ℓ, a miss, in sphere radii, over up to `RAYS` evenly spread rays.

    That of a ray which hits is the way from its second hit to the sphere's far side: the price
    of a light leak. Where nothing is hit it is zero.
    """
    count = min(rays.count, RAYS)
    total = 0.0
    for start in range(0, count, _CHUNK):
        chosen = np.arange(start, min(start + _CHUNK, count)) * rays.count // count
        batch = LabelledBatch(*map(torch.from_numpy, rays.gather(chosen)))
        chord = chords(batch.origins, batch.directions)
        total += dead_zone(chord, batch.t_lb, batch.t_ub).double().sum().item()
    return total / count

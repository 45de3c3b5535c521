"""Loss of predicting no shadow, a null predictor."""

import numpy as np
import torch

from neural_shadows.networks.object_space.dead_zone_loss import DeadZone
from neural_shadows.networks.object_space.shadow_network import LabelledBatch, chords
from neural_shadows.rays.ray_set import RaySet

# Their mean differs from that of all rays by about a thousandth.
RAYS = 1 << 20
_CHUNK = 1 << 16


def no_shadow_loss(rays: RaySet, dead_zone: DeadZone) -> float:
    """Mean dead-zone loss of misses: t = ℓ, in sphere radii.

    Over up to `RAYS` evenly spread rays. A hit's loss is the length from its second hit to the
    sphere's far side: the price of a light leak. Without any hit it is zero.
    """
    count = min(rays.count, RAYS)
    total = 0.0
    for start in range(0, count, _CHUNK):
        indices = np.arange(start, min(start + _CHUNK, count)) * rays.count // count
        batch = LabelledBatch(*map(torch.from_numpy, rays.gather(indices)))
        chord = chords(batch.origins, batch.directions)
        total += dead_zone(chord, batch.t_lb, batch.t_ub).double().sum().item()
    return total / count

"""Lit points of a shadow network [3.6], on its device."""

from collections.abc import Callable

import numpy as np
import torch
from torch import Tensor

from neural_shadows.networks.object_space.shadow_network import ShadowNetwork
from neural_shadows.networks.object_space.sphere_rays import sphere_rays


def network_lit(
    network: ShadowNetwork,
    p: Tensor,
    light: Tensor,
    *,
    dtype: torch.dtype,
    t_pred: Tensor | None = None,
) -> Callable[[float], Tensor]:
    """Evaluate a network once for any number of depth biases [3.6.2].

    p and light as for `sphere_rays`, in normalised space and on the network's device; `t_pred` are
    the depths of their rays, if already predicted.

    Returns:
        a function from the depth bias, in sphere radii, to (m,) bool: lit points. See
        `ShadowNetwork.lit`; culled points are lit.
    """
    rays = sphere_rays(p, light)
    rays_lit = network.lit(rays, -light, dtype, t_pred)

    def lit(depth_bias: float) -> Tensor:
        points = torch.ones(len(p), dtype=torch.bool, device=p.device)
        return points.scatter_(0, rays.index, rays_lit(depth_bias))

    return lit


def on_device(points: np.ndarray, light: np.ndarray, device: torch.device) -> tuple[Tensor, Tensor]:
    """Points (m, 3) float32 and light (3,) as tensors on a device."""
    light = torch.from_numpy(np.asarray(light, np.float32))
    return torch.from_numpy(points).to(device), light.to(device)

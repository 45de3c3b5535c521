"""Which points a shadow network calls lit [3.6]; all on the device that the network is on."""

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
    """What a network says of points, asked once for any number of depth biases [3.6.2].

    p and light are as of `sphere_rays`, in normalised space and on the network's device; `t_pred`
    are the depths of their rays, where they are known already.

    Returns:
        a function of the depth bias, in units of the sphere's radius, that gives (m,) bool: which
        points are lit. See `ShadowNetwork.lit`; culled points are.
    """
    rays = sphere_rays(p, light)
    rays_lit = network.lit(rays, -light, dtype, t_pred)

    def lit(depth_bias: float) -> Tensor:
        points = torch.ones(len(p), dtype=torch.bool, device=p.device)
        return points.scatter_(0, rays.index, rays_lit(depth_bias))

    return lit


def on_device(points: np.ndarray, light: np.ndarray, device: torch.device) -> tuple[Tensor, Tensor]:
    """Points (m, 3) float32 and a light (3,) as the functions above take them."""
    light = torch.from_numpy(np.asarray(light, np.float32))
    return torch.from_numpy(points).to(device), light.to(device)

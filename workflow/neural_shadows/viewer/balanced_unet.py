"""A U-Net without norms whose maps fit half precision."""

from copy import deepcopy

import torch
from torch import nn

from neural_shadows.networks.screen_space.layers import Sum
from neural_shadows.networks.screen_space.shadow_unet import ShadowUnet

_SIDE = 128  # pixels of the noise


def balanced(network: ShadowUnet) -> ShadowUnet:
    """The same function with maps of about 1.

    ReLUs let factors pass, so that a convolution may give any multiple of its output, and the next take
    it back; summed maps share theirs. A trained network has maps up to 2e7, where half precision ends
    at 65,504, and weights of 1e-7 behind them. Magnitudes are those of normal noise.
    """
    network = deepcopy(network).requires_grad_(False)
    sizes = _magnitudes(network)
    scale = 1.0
    if network.extraction is not None:
        scale = _rescale(network.extraction, sizes, scale, 1 / _last(network.extraction, sizes))
    inner_goals = []  # of what is enlarged to a level
    inner = [level.decoder for level in network.levels[1:]] + [network.deepest]
    for level, within in zip(network.levels, inner):
        outer_size, inner_size = _last(level.encoder, sizes), _last(within, sizes)
        if isinstance(level.skip, Sum):
            outer_size = inner_size = max(outer_size, inner_size)
        inner_goals.append(1 / inner_size)
        scale = _rescale(level.encoder, sizes, scale, 1 / outer_size)
    for layers, goal in zip(
        [*reversed(inner), network.levels[0].decoder], [*reversed(inner_goals), 1.0]
    ):
        scale = _rescale(layers, sizes, scale, goal)
    return network


def _magnitudes(network: ShadowUnet) -> dict[nn.Module, float]:
    """Size of each convolution's output."""
    sizes: dict[nn.Module, float] = {}
    hooks = [
        layer.register_forward_hook(lambda layer, _, output: sizes.update({layer: _size(output)}))
        for layer in network.modules()
        if isinstance(layer, nn.Conv2d)
    ]
    noise = torch.randn(
        (1, len(network.centres), _SIDE, _SIDE), generator=torch.Generator().manual_seed(0)
    )
    network(noise * network.spreads[:, None, None] + network.centres[:, None, None])
    for hook in hooks:
        hook.remove()
    return sizes


def _size(output: torch.Tensor) -> float:
    """The largest number: ReLUs take away what is below 0, unless there is nothing else."""
    return max(float(output.max()), float(output.abs().max()) / 1000, 1e-6)


def _last(layers: nn.Sequential, sizes: dict[nn.Module, float]) -> float:
    return [sizes[layer] for layer in layers if layer in sizes][-1]


def _rescale(
    layers: nn.Sequential, sizes: dict[nn.Module, float], scale: float, goal: float
) -> float:
    """Rescale convolutions whose input has a factor, until the last gives `goal` times its output."""
    convolutions = [layer for layer in layers if layer in sizes]
    for layer in convolutions:
        own = goal if layer is convolutions[-1] else 1 / sizes[layer]
        layer.weight.mul_(own / scale)
        layer.bias.mul_(own)
        scale = own
    return scale

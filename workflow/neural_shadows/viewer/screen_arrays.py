"""Plans and weights of screen-space networks for the viewer's screen_network.js."""

from collections.abc import Iterable, Mapping, Sequence
from copy import deepcopy
from typing import Any

import numpy as np
import torch
from torch import Tensor, nn
from torch.nn import functional

from neural_shadows.errors import InputError
from neural_shadows.frames.feature_names import GUIDE, base_of, channels_of
from neural_shadows.networks.screen_space.kernel_unet import KernelUnet
from neural_shadows.networks.screen_space.kernel_widths import KERNEL_TAPS
from neural_shadows.networks.screen_space.layers import (
    Halved,
    ReplicatedConvolution,
    SquaresAsChannels,
)
from neural_shadows.networks.screen_space.screen_network import ScreenNetwork
from neural_shadows.networks.screen_space.shadow_unet import ShadowUnet
from neural_shadows.networks.settings.screen_space import SHADED
from neural_shadows.viewer.balanced_unet import balanced
from neural_shadows.viewer.packed import packed

_ENTRANCES = {SquaresAsChannels: "SQUARES", Halved: "MEANS"}
_MOST_HALF = torch.finfo(torch.float16).max


def screen_arrays(network: ScreenNetwork, header: Mapping[str, Any]) -> dict[str, Any]:
    """Layers of a network in order, its input, and its packed `arrays`.

    Args:
        network, header: of `load_screen_network`.

    Returns:
        `plan`: steps with `kind`, `level` and settings of the shaders; each reads the one before it, and
        `skip`, `logits` and `guides` are numbers of earlier steps. `features` and `rays` are what
        the `planes` are made from; `centres` and `spreads` normalise them. `base` and `guide`: planes that
        kernels filter and are kept by.

    Raises:
        InputError: a form without shaders, or weights beyond the range of half precision.
    """
    _check(header["network"])
    rounded = with_half_weights(network)
    planes = channels_of(rounded.features)
    plan = _Plan()
    data: dict[str, Any] = {
        "features": list(rounded.features),
        "planes": planes,
        "rays": header.get("rays", 0),
    }
    if isinstance(rounded, ShadowUnet):
        data |= {"centres": rounded.centres.tolist(), "spreads": rounded.spreads.tolist()}
        _add_shadow_unet(plan, rounded, planes)
    else:
        data |= {"centres": [0.0] * planes, "spreads": [1.0] * planes}
        _add_kernel_unet(plan, rounded, planes)
        if rounded.form == "kernels":
            data |= _filtered_planes(rounded)
    weights = np.concatenate(plan.weights).astype(np.float16)
    return data | {"plan": plan.steps, "arrays": {"weights": packed(weights.view(np.uint16))}}


def with_half_weights(network: ScreenNetwork) -> ScreenNetwork:
    """The network as a viewer evaluates it.

    Norms are folded into convolutions, maps without norms balanced; weights are then rounded to half
    precision and kept in float32.

    Raises:
        InputError: a weight beyond the range of half precision.
    """
    rounded = deepcopy(network.for_inference()).requires_grad_(False)
    if isinstance(rounded, ShadowUnet):
        rounded = balanced(rounded)
    for name, weight in rounded.named_parameters():
        largest = weight.abs().max()
        if not largest <= _MOST_HALF:  # catches NaN
            raise InputError(
                f"{name}: {largest:.4g}: beyond the range of half precision, {_MOST_HALF:,.0f}. "
                "Train the network again with a smaller learning rate."
            )
        weight.copy_(weight.half().float())
    return rounded


def _check(settings: Mapping[str, Any]) -> None:
    for key, shown in SHADED.items():
        value = settings.get(key, shown[0])
        if value not in shown:
            raise InputError(
                f"{key}: {value!r}: the viewer has no shaders for it. Show a network with "
                f"{key}: {' or '.join(shown)}."
            )


class _Plan:
    """Steps of a network, and the weights of its convolutions in their order."""

    def __init__(self):
        self.steps: list[dict[str, Any]] = []
        self.weights: list[np.ndarray] = []

    def add(self, kind: str, level: int, **settings: Any) -> int:
        """Append a step, and return its number."""
        self.steps.append({"kind": kind, "level": level} | settings)
        return len(self.steps) - 1

    def add_resized(self, kind: str, level: int, **settings: Any) -> int:
        """Append a step that leaves the channels as they are."""
        return self.add(kind, level, channels=self.steps[-1]["channels"], **settings)

    def add_layers(self, level: int, layers: Iterable[nn.Module]) -> int:
        """Append convolutions and their ReLUs; return the last step's number."""
        for layer in layers:
            if isinstance(layer, nn.ReLU):
                self.steps[-1]["relu"] = True
            else:
                border = "REPLICATED" if isinstance(layer, ReplicatedConvolution) else "ZERO"
                self.add_convolution(level, layer.weight, layer.bias, border)
        return len(self.steps) - 1

    def add_convolution(self, level: int, weight: Tensor, bias: Tensor, border: str) -> None:
        """Append a convolution of a weight (outputs, inputs, size, size)."""
        outputs, inputs, size, _ = weight.shape
        sizes = {"channels": outputs, "inputs": inputs, "size": size}
        self.add("convolution", level, **sizes, border=border, relu=False)
        self.weights.append(_blocks(weight, bias))


def _blocks(weight: Tensor, bias: Tensor) -> np.ndarray:
    """Rows of a convolution's texture: 4 outputs × 4 inputs, padded with zeros.

    Of each tap the block, column by column; then a texel of 8 numbers, with the bias in the first row of
    these outputs.
    """
    outputs, inputs = weight.shape[:2]
    taps = functional.pad(weight.flatten(2), (0, 0, 0, -inputs % 4, 0, -outputs % 4))
    groups = taps.unflatten(1, (-1, 4)).unflatten(0, (-1, 4)).permute(0, 2, 4, 3, 1)
    last = torch.zeros(*groups.shape[:2], 8)
    last[:, 0, :4] = functional.pad(bias, (0, -outputs % 4)).view(-1, 4)
    return torch.cat([groups.flatten(2), last], dim=2).flatten().numpy()


def _add_shadow_unet(plan: _Plan, network: ShadowUnet, planes: int) -> None:
    level = _add_entrance(plan, network.entrance, planes)
    if network.extraction is not None:
        plan.add_layers(level, network.extraction)
    _add_down_and_up(plan, network, level)
    plan.add("exit", 0, mode="SQUARES" if level else "PIXELS")


def _add_kernel_unet(plan: _Plan, network: KernelUnet, planes: int) -> None:
    level = _add_entrance(plan, network.entrance, planes)
    _add_down_and_up(plan, network, level)
    if network.form == "direct":
        plan.add_resized("enlargement", 0)
        plan.add_layers(0, network.head)
        plan.add("exit", 0, mode="PIXELS")
        return
    # Whole groups of four taps, the last ones without weight.
    lacking = -KERNEL_TAPS % 4
    head = network.head
    weight = head.weight.unflatten(0, (-1, KERNEL_TAPS))
    weight = functional.pad(weight, (0, 0) * 3 + (0, lacking)).flatten(0, 1)
    bias = functional.pad(head.bias.view(-1, KERNEL_TAPS), (0, lacking), value=-_MOST_HALF)
    plan.add_convolution(level, weight, bias.flatten(), "ZERO")
    logits = len(plan.steps) - 1
    guides, groups = plan.add("base", 0), (KERNEL_TAPS + lacking) // 4
    for number in range(network.filters):
        settings = {"dilation": 2**number, "first": groups * number}
        plan.add("filter", 0, **settings, logits=logits, guides=guides)
    plan.add("filtered", 0)


def _add_entrance(plan: _Plan, entrance: nn.Module | None, planes: int) -> int:
    """Append the first step, and return its level."""
    mode = _ENTRANCES.get(type(entrance), "PIXELS")
    level = int(mode != "PIXELS")
    plan.add("entrance", level, channels=planes * (4 if mode == "SQUARES" else 1), mode=mode)
    return level


def _add_down_and_up(plan: _Plan, network: ShadowUnet | KernelUnet, first: int) -> None:
    """As `layers.down_and_up`."""
    levels, skips = list(enumerate(network.levels, first)), []
    for number, level in levels:
        skips.append(plan.add_layers(number, level.encoder))
        mode = "MAXIMUM" if isinstance(level.downsample, nn.MaxPool2d) else "MEAN"
        plan.add_resized("pool", number + 1, mode=mode)
    plan.add_layers(first + len(levels), network.deepest)
    for number, level in reversed(levels):
        if isinstance(level.upsample, nn.ConvTranspose2d):
            upsample = level.upsample
            plan.add_convolution(number, upsample.weight.transpose(0, 1), upsample.bias, "ZERO")
        else:
            plan.add_resized("enlargement", number)
        skip = skips.pop()
        if level.skip is not None:
            plan.steps[-1]["skip"] = skip
        plan.add_layers(number, level.decoder)


def _filtered_planes(network: KernelUnet) -> dict[str, Any]:
    """Numbers of the planes that kernels filter and are kept by; without an edge None."""
    features, edge = network.features, network.exit.limit
    guided = np.isfinite(edge)
    return {
        "base": _plane_of(base_of(features), features),
        "guide": _plane_of(GUIDE, features) if guided else None,
        "edge": edge if guided else None,
    }


def _plane_of(name: str, features: Sequence[str]) -> int:
    return channels_of(features[: features.index(name)])

"""Arrays and constants of networks for the viewer's shaders."""

from typing import Any

import numpy as np
import torch
from torch import Tensor

from neural_shadows.networks.object_space.frequency_network import FrequencyNetwork
from neural_shadows.networks.object_space.occupancy_field_network import OccupancyFieldNetwork
from neural_shadows.networks.object_space.shadow_network import ShadowNetwork
from neural_shadows.networks.quantisation import quantise
from neural_shadows.representations.distance_bricks.field_marching import SAMPLES_PER_CELL, SOLID
from neural_shadows.viewer.packed import packed

SOLID_CODE = 255  # of a brick; 0: has values, others: number of bricks to skip


def network_arrays(network: ShadowNetwork) -> dict[str, Any]:
    """Settings of a field or network, and its packed `arrays`.

    Raises:
        TypeError: the kind has no shader.
    """
    if isinstance(network, OccupancyFieldNetwork):
        return _field(network)
    if isinstance(network, FrequencyNetwork):
        return _frequency_network(network)
    raise TypeError(f"no shader for a {type(network).__name__}")


def _field(network: OccupancyFieldNetwork) -> dict[str, Any]:
    """Field with one byte per brick and per value.

    Values are shares of the largest."""
    values, scale = quantise({"": network.shares().detach()}, "int8").values()
    grid = network.grid.numpy()
    codes = np.where(grid >= 0, 0, np.minimum(-grid, SOLID_CODE - 1))
    codes[grid == SOLID] = SOLID_CODE
    return {
        "bricks": round(len(grid) ** (1 / 3)),
        "surface": network.surface,
        "samples_per_cell": SAMPLES_PER_CELL,
        "level": network.level() / float(scale),
        "arrays": {"grid": packed(codes.astype(np.uint8)), "values": packed(values.numpy())},
    }


def _frequency_network(network: FrequencyNetwork) -> dict[str, Any]:
    """Weights as float16, in the order of network.glsl."""
    layers = [_blocks(weight.detach()) for weight in network.layers]
    output = network.output.detach().reshape(-1).numpy()
    output = np.pad(output, (0, -len(output) % 4))
    weights = np.concatenate([*layers, output]).astype(np.float16)
    return {
        "frequencies": len(network.encoding.scale),
        "width": len(output),
        "hidden_layers": len(network.layers) - 1,
        "arrays": {"weights": packed(weights.view(np.uint16))},
    }


def _blocks(weight: Tensor) -> np.ndarray:
    """Matrix (out, in) in zero-padded 4 × 4 blocks, column by column."""
    out, into = weight.shape
    padded = torch.nn.functional.pad(weight, (0, -into % 4, 0, -out % 4))
    blocks = padded.reshape(len(padded) // 4, 4, -1, 4)
    return blocks.permute(0, 2, 3, 1).reshape(-1).numpy()

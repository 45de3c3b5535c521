"""Arrays and constants of networks for the viewer's shaders."""

from typing import Any

import numpy as np
import torch
from torch import Tensor

from neural_shadows.networks.object_space.frequency_network import FrequencyNetwork
from neural_shadows.networks.object_space.occupancy_field_network import (
    CELL_SHARE,
    OccupancyFieldNetwork,
)
from neural_shadows.networks.object_space.shadow_network import ShadowNetwork
from neural_shadows.networks.quantisation import quantise
from neural_shadows.representations.distance_bricks.field_marching import (
    BRICK,
    BRICK_VERTICES,
    SAMPLES_PER_CELL,
)
from neural_shadows.representations.shadow_field.grid_codes import grid_codes
from neural_shadows.viewer.field_arrays import cone_arrays
from neural_shadows.viewer.packed import packed


def network_arrays(network: ShadowNetwork, trained: bool) -> dict[str, Any]:
    """Settings of a field or network, and its packed `arrays`.

    Raises:
        TypeError: the kind has no shader.
    """
    if isinstance(network, OccupancyFieldNetwork):
        return _field(network, trained)
    if isinstance(network, FrequencyNetwork):
        return _frequency_network(network)
    raise TypeError(f"no shader for a {type(network).__name__}")


def _field(network: OccupancyFieldNetwork, trained: bool) -> dict[str, Any]:
    """Field with one byte per brick and per value.

    Values are shares of the largest. Untrained ones are distances, for cones.
    """
    values, scale = quantise({"": network.shares().detach()}, "int8").values()
    size = network.resolution // BRICK
    grid = network.grid.view(size, size, size).numpy()
    field = {
        "bricks": size,
        "surface": network.surface,
        "samples_per_cell": SAMPLES_PER_CELL,
        "level": network.level() / float(scale),
        "arrays": {"grid": packed(grid_codes(grid.ravel())), "values": packed(values.numpy())},
    }
    if network.start != "undecided" and network.storage != "sign" and not trained:
        cell = 2 / network.resolution
        bricks = values.numpy()[network.table.view(-1, BRICK_VERTICES).numpy()]
        cones = cone_arrays(grid, bricks, float(scale) / CELL_SHARE * cell, network.push)
        return {**field, **cones, "arrays": field["arrays"] | cones["arrays"]}
    return field


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

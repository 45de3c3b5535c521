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
from neural_shadows.representations.distance_bricks.distances_around import distances_around
from neural_shadows.representations.distance_bricks.field_marching import (
    BRICK,
    BRICK_VERTICES,
    SAMPLES_PER_CELL,
)
from neural_shadows.representations.shadow_field.grid_codes import grid_codes
from neural_shadows.viewer.packed import packed, zigzag

STEP_CELLS = 1 / 8  # of a distance around a field


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
        step = cell * STEP_CELLS
        field |= {"unit": float(scale) / CELL_SHARE * cell, "push": network.push, "step": step}
        field["arrays"]["around"] = packed(_differences(distances_around(grid, bricks), step))
    return field


def _differences(distances: np.ndarray, step: float) -> np.ndarray:
    """A cube's values in steps, as differences along all three axes; zigzag uint16.

    Of the Stanford dragon at 256³ 104 KiB, deflated; as halves 299.
    """
    steps = np.round(distances / step).astype(np.int64)
    for axis in range(3):
        steps = np.diff(steps, axis=axis, prepend=0)
    return zigzag(steps)


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

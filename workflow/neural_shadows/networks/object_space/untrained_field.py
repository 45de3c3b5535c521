"""The field of a mesh that nothing is trained for: a minute less, and as good for most uses."""

from pathlib import Path

import torch

from neural_shadows.networks.object_space.field_bricks import FieldBricks
from neural_shadows.networks.object_space.occupancy_field_network import OccupancyFieldNetwork


def untrained_field(mesh_ply: Path, resolution: int) -> FieldBricks:
    """Distances fitted to where a solid's shadows end, int8, see `fitted_distances`.

    Args:
        mesh_ply: of a solid, in its unit sphere.
        resolution: cells along an axis, a multiple of 4.
    """
    told = {"surface": "solid", "stored": "int8", "start": "fitted"}
    network = OccupancyFieldNetwork(resolution=resolution, **told)
    with torch.no_grad():
        network.prepare(mesh_ply)
        network.initialise(0)
    return network.held_bricks()

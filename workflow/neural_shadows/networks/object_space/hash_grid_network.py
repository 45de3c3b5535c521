"""Ray grid over multiresolution hash tables (Müller et al. 2022, Instant-NGP)."""

from typing import Any

from torch import Tensor

from neural_shadows.networks.object_space.occupancy_ray_grid_network import OccupancyRayGridNetwork
from neural_shadows.networks.object_space.ray_grid_network import FeatureGrid

# Of Instant-NGP's vertex hash.
PRIMES = (1, 2654435761, 805459861)


class HashedGrid(FeatureGrid):
    """Feature grid with a hash table of 2^n entries; dense if possible."""

    def __init__(self, resolution: int, channels: int, table_size: int):
        super().__init__(resolution, channels, min(resolution**3, table_size))

    def index(self, vertices: Tensor) -> Tensor:
        if len(self.values) == self.resolution**3:
            return super().index(vertices)
        x, y, z = (vertices * vertices.new_tensor(PRIMES)).unbind(-1)
        return (x ^ y ^ z) & (len(self.values) - 1)


class HashGridNetwork(OccupancyRayGridNetwork):
    """t_pred(o, d) from hashed features on the occupied part of rays.

    Args:
        table_size: entries of each grid's hash table, a power of two.
    """

    def __init__(self, *, table_size: int, **settings: Any):
        self.table_size = table_size
        super().__init__(**settings)

    def feature_grid(self, resolution: int, channels: int) -> HashedGrid:
        """See `RayGridNetwork.feature_grid`."""
        return HashedGrid(resolution, channels, self.table_size)

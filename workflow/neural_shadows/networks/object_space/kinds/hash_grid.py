"""An occupancy-clipped ray grid over hash tables (Instant-NGP)."""

from typing import Literal

from pydantic import Field

from neural_shadows.networks.object_space.kinds import occupancy_ray_grid
from neural_shadows.settings.base import PowerOfTwo


class Settings(occupancy_ray_grid.Settings):
    """An occupancy-clipped ray grid over hash tables (Instant-NGP)."""

    encoding: Literal["hash_grid"] = Field(description="`hash_grid`: multiresolution hash tables")
    table_size: PowerOfTwo = Field(65536, ge=16, le=1 << 24, description="of a grid's, in entries")


def network_class() -> type:
    from neural_shadows.networks.object_space.hash_grid_network import HashGridNetwork

    return HashGridNetwork

"""A ray grid between a ray's outermost occupied cells."""

from typing import ClassVar, Literal

from pydantic import Field

from neural_shadows.networks.object_space.kinds import ray_grid


class Settings(ray_grid.Settings):
    """A ray grid between a ray's outermost occupied cells."""

    needs_mesh: ClassVar[bool] = True
    encoding: Literal["occupancy_ray_grid"] = Field(description="points near the surface")
    occupancy: int = Field(64, ge=2, le=512, description="cells along an axis of the occupancy")


def network_class() -> type:
    from neural_shadows.networks.object_space.occupancy_ray_grid_network import (
        OccupancyRayGridNetwork,
    )

    return OccupancyRayGridNetwork

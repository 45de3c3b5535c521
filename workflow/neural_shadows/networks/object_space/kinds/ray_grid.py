"""A small network over dense 3-D grids along the ray."""

from typing import Annotated, Literal

from pydantic import Field

from neural_shadows.networks.settings.object_space import NetworkModel, Stored


class Settings(NetworkModel):
    """A small network over dense 3-D grids along the ray."""

    encoding: Literal["ray_grid"] = Field(description="`ray_grid`: points on the whole chord")
    points: int = Field(8, ge=1, le=256, description="K, points along the ray")
    grids: list[Annotated[int, Field(ge=2, le=512)]] = Field(
        [16, 32, 60], min_length=1, description="vertices of an axis"
    )
    channels: int = Field(4, ge=1, le=64, description="trained features of a grid's vertex")
    width: int = Field(64, ge=8, le=4096, description="neurons per layer")
    hidden_layers: int = Field(3, ge=1, le=64, description="layers before the output")
    head: Literal["depth", "depth_confidence"] = Field(
        "depth_confidence", description="`depth_confidence`: a second output for hit or miss"
    )
    stored: Stored = Field("float16", description="format of the weights in the weight file")

    @property
    def hidden_matrices(self) -> int:
        return self.hidden_layers - 1  # the first is behind the grids


def network_class() -> type:
    from neural_shadows.networks.object_space.ray_grid_network import RayGridNetwork

    return RayGridNetwork

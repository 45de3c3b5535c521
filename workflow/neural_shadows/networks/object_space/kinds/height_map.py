"""Heights of a landscape over a grid; not trained."""

from typing import ClassVar, Literal

from pydantic import Field

from neural_shadows.networks.settings.object_space import NetworkModel


class Settings(NetworkModel):
    """Heights of a landscape over a grid; not trained."""

    trained: ClassVar[bool] = False
    needs_mesh: ClassVar[bool] = True
    of_scene: ClassVar[tuple[str, ...]] = ("up",)  # the axis of the heights
    encoding: Literal["height_map"] = Field(description="`height_map`: heights, not trained")
    resolution: int = Field(257, ge=2, le=4097, description="heights along a side")
    bits: int = Field(16, ge=8, le=16, multiple_of=8, description="of a height")
    up: Literal["x", "y", "z"] | None = Field(
        None, description="axis of the heights; default: the scene's `up`"
    )


def network_class() -> type:
    from neural_shadows.networks.untrained.height_map_network import HeightMapNetwork

    return HeightMapNetwork

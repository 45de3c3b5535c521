"""The mesh itself, decimated and quantised, traced exactly."""

from typing import Annotated, ClassVar, Literal

from pydantic import Field, model_validator

from neural_shadows.networks.settings.object_space import NetworkModel
from neural_shadows.representations.meshes.coded_mesh import MOST_BITS


class Settings(NetworkModel):
    """The mesh itself, decimated and quantised, traced exactly."""

    trained: ClassVar[bool] = False
    needs_mesh: ClassVar[bool] = True
    encoding: Literal["mesh"] = Field(description="`mesh`: traced exactly, without a training")
    triangles: Annotated[int, Field(ge=4)] | None = Field(
        None, description="the most it is decimated to; all of them by default"
    )
    bits: int = Field(16, ge=4, le=24, description="of a vertex's coordinate")
    stored: Literal["packed", "coded"] = Field(
        "packed",
        description="how the weight file holds it: `packed`, bits and no more; `coded` by Draco, the "
        "same mesh in a seventh to a quarter of the bytes",
    )

    @model_validator(mode="after")
    def _check_bits(self):
        if self.stored == "coded" and self.bits > MOST_BITS:
            raise ValueError(
                f"bits = {self.bits}: a coded mesh has at most {MOST_BITS}; give fewer, or set "
                "stored: packed"
            )
        return self


def network_class() -> type:
    from neural_shadows.networks.untrained.mesh_network import MeshNetwork

    return MeshNetwork

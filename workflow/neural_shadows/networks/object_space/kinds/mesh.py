"""The mesh itself, decimated and quantised, traced exactly."""

from typing import Annotated, ClassVar, Literal

from pydantic import Field, model_validator

from neural_shadows.networks.settings.object_space import NetworkModel
from neural_shadows.representations.meshes.coded_mesh import MOST_BITS


class Settings(NetworkModel):
    """The mesh itself, decimated and quantised, traced exactly."""

    trained: ClassVar[bool] = False
    needs_mesh: ClassVar[bool] = True
    encoding: Literal["mesh"] = Field(description="`mesh`: traced exactly, untrained")
    triangles: Annotated[int, Field(ge=4)] | None = Field(
        None, description="upper bound after decimation; all by default"
    )
    bits: int = Field(16, ge=4, le=24, description="of a vertex's coordinate")
    stored: Literal["packed", "coded"] = Field(
        "packed",
        description="format in the weight file: `packed` bits; `coded` by Draco, the same mesh in a "
        "seventh to a quarter of the bytes",
    )

    @model_validator(mode="after")
    def _check_bits(self):
        if self.stored == "coded" and self.bits > MOST_BITS:
            raise ValueError(
                f"bits: {self.bits}: more than the {MOST_BITS} of a coded mesh. Give fewer, or set "
                "stored: packed."
            )
        return self


def network_class() -> type:
    from neural_shadows.networks.untrained.mesh_network import MeshNetwork

    return MeshNetwork

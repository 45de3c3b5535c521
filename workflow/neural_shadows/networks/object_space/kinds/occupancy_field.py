"""One trained logit at each grid vertex near the surface."""

from typing import ClassVar, Literal

from pydantic import Field, model_validator

from neural_shadows.networks.settings.object_space import SURFACE, NetworkModel, Stored, Surface


class Settings(NetworkModel):
    """One trained logit at each grid vertex near the surface."""

    needs_mesh: ClassVar[bool] = True
    holds_field: ClassVar[bool] = True
    has_shader: ClassVar[bool] = True
    encoding: Literal["occupancy_field"] = Field(
        description="inside or outside, without a direction"
    )
    resolution: int = Field(256, ge=8, le=1024, multiple_of=4, description="cells of an axis")
    surface: Surface = Field("auto", description=SURFACE)
    start: Literal["undecided", "distances", "fitted"] = Field(
        "undecided",
        description="initial logits: near zero, or signed distances to the mesh, exact or "
        "`fitted` to its shadow boundaries; both are usable without training",
    )
    stored: Stored | Literal["coded", "sign"] = Field(
        "int8",
        description="format of the logits in the weight file; `coded`: compressed, of crossed "
        "cells only; `sign`: a bit each",
    )
    corner_bits: Literal[4, 8] = Field(
        8,
        description="bits of each corner of crossed cells in a CPU's memory; 4 take three fifths of the "
        "memory and cost the dragon at 256³ 0.6 dB",
    )

    @property
    def needs_training(self) -> bool:
        return self.start == "undecided"

    @model_validator(mode="after")
    def _check_inside(self):
        if self.start != "undecided" and self.surface == "sheet":
            raise ValueError(
                f"start: {self.start}: surface: sheet has no inside. Set start: undecided, or leave "
                "out the surface."
            )
        return self


def network_class() -> type:
    from neural_shadows.networks.object_space.occupancy_field_network import OccupancyFieldNetwork

    return OccupancyFieldNetwork

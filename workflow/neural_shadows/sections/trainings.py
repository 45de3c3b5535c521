"""`trainings`: how long and how fast a network learns."""

from typing import Literal

from pydantic import Field

from neural_shadows.settings.base import Model, by_kind


class Loss(Model):
    """The dead-zone loss, and a change to it [3.5, 5.1]."""

    false_shadow: float = Field(
        1.0, ge=0, le=1000, description="weight of depths before the first hit"
    )


class Adam(Model):
    """Adam on the network's loss [3.5, 4.1]."""

    optimiser: Literal["adam"] = Field("adam", description="`adam`, the default: the thesis's")
    steps: int = Field(ge=1, description="optimiser steps")
    # From 16: in a batch of a few rays, equal predictions do not yet mean a dead network.
    batch_size: int = Field(ge=16, le=1 << 24, description="samples per step")
    learning_rate: float = Field(gt=0, le=1, description="the optimiser's rate (at its start)")
    schedule: Literal["constant", "cosine"] = Field(
        "constant", description="of the rate: constant (thesis) or cosine to zero"
    )
    loss: Loss = Field(Loss(), description="of depths, which an occupancy_field has none of")


class Muon(Adam):
    """Muon for the hidden layers, Adam for all else."""

    optimiser: Literal["muon"] = Field(description="`muon`: for networks with hidden layers")
    adam_rate: float = Field(
        0.001, gt=0, le=1, description="Adam's rate, of the first layer, the last and grids"
    )


Training = by_kind("optimiser", Adam, Muon, default="adam")

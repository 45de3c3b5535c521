"""`trainings`: how long and how fast a network learns."""

from typing import Literal

from pydantic import Field

from neural_shadows.config.base import Model


class Loss(Model):
    """The dead-zone loss, and a change to it [3.5, 5.1]."""

    false_shadow: float = Field(
        1.0, ge=0, le=1000, description="weight of depths before the first hit"
    )


class Training(Model):
    """Adam on the network's loss [3.5, 4.1]."""

    steps: int = Field(ge=1, description="optimiser steps")
    # From 16: in a batch of a few rays, equal predictions do not yet mean a dead network.
    batch_size: int = Field(ge=16, le=1 << 24, description="samples per step")
    learning_rate: float = Field(gt=0, le=1, description="Adam's learning rate (at its start)")
    schedule: Literal["constant", "cosine"] = Field(
        "constant", description="of the rate: constant (thesis) or cosine to zero"
    )
    loss: Loss = Field(Loss(), description="of depths, which an occupancy_field has none of")

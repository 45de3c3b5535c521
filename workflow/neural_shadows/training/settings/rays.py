"""Trainings on rays: optimiser, steps and schedule."""

from typing import Literal

from pydantic import Field

from neural_shadows.settings.base import Model, by_kind


class Loss(Model):
    """Dead-zone loss with an adjustable weight [3.5, 5.1]."""

    false_shadow: float = Field(
        1.0,
        ge=0,
        le=1000,
        description="weight of predictions before the first hit, which give false shadow; 1 is the thesis's",
    )


class Adam(Model):
    """Adam on the network's loss [3.5, 4.1]."""

    optimiser: Literal["adam"] = Field("adam", description="`adam`, the default: the thesis's")
    steps: int = Field(ge=1, description="optimiser steps")
    # From 16: equal predictions in a smaller batch do not imply that a training diverged.
    batch_size: int = Field(ge=16, le=1 << 24, description="samples per step")
    learning_rate: float = Field(gt=0, le=1, description="initial learning rate")
    schedule: Literal["constant", "cosine"] = Field(
        "constant", description="learning-rate schedule: constant (thesis) or cosine to zero"
    )
    loss: Loss = Field(Loss(), description="loss of depths; without effect on an occupancy_field")


class Muon(Adam):
    """Muon for hidden layers, Adam for the remaining weights."""

    optimiser: Literal["muon"] = Field(description="`muon`: for networks with hidden layers")
    adam_rate: float = Field(
        0.001,
        gt=0,
        le=1,
        description="learning rate of Adam, for the first layer, the last and grids",
    )


RayTraining = by_kind("optimiser", Adam, Muon, default="adam")

"""Trainings on frames (Datta et al. 2022, 3.3)."""

from typing import Annotated, Literal

from pydantic import Field, model_validator

from neural_shadows.settings.base import Model, Text, by_kind


class Squeeze(Model):
    """SqueezeNet 1.1: features of its first ReLU and of fire3."""

    net: Literal["squeeze"] = Field(
        "squeeze",
        description="`squeeze`: weights of metrics.lpips.trunk; without perceptual loss if metrics.lpips.net is "
        "another",
    )


class Vgg19(Model):
    """VGG-19, as in Datta et al. 2022: features of relu2_2, a layer that they do not name."""

    net: Literal["vgg19"] = Field(description="`vgg19`, as in the paper")
    trunk: Text = Field(description="local weights file of torchvision's vgg19")


class NoPerceptual(Model):
    """L1 alone."""

    net: Literal["none"] = Field(description="`none`: L1 alone")


class ScreenTraining(Model):
    """Optimiser, crops and losses of a screen-space network."""

    optimiser: Literal["adam", "muon"] = Field(
        "adam", description="`adam`, or `muon` for all convolutions except the first and last"
    )
    steps: int = Field(ge=1, description="optimiser steps")
    crops: int = Field(ge=1, le=1024, description="crops per step")
    crop: int = Field(ge=2, le=4096, description="side of a crop, pixels; at most the frame")
    learning_rate: float = Field(gt=0, le=1, description="initial learning rate")
    adam_rate: float = Field(
        0.003,
        gt=0,
        le=1,
        description="with `muon`: learning rate of Adam, for the remaining weights",
    )
    schedule: Literal["constant", "cosine", "steps"] = Field(
        "cosine",
        description="learning-rate schedule: constant, cosine to zero, or divided by ten at `tenth_from`",
    )
    tenth_from: list[Annotated[int, Field(ge=1)]] = Field(
        [], description="with `schedule: steps`: steps at which the rate is divided by ten"
    )
    alpha: float = Field(0.9, ge=0, le=1, description="weight of L1; 1 − alpha: perceptual loss")
    perceptual: by_kind("net", Squeeze, Vgg19, NoPerceptual, default="squeeze") = Field(
        Squeeze(), description="perceptual loss: distance between pretrained features"
    )
    perturbation: float = Field(
        3.0, ge=0, le=100, description="weight of the temporal loss on perturbed frames; 0 for none"
    )
    perturbation_from: float = Field(
        0.0, ge=0, lt=1, description="share of the steps before the temporal loss starts"
    )
    aligned: bool = Field(
        False,
        description="whether the perturbed frame's output is reprojected to the frame before comparison; "
        "otherwise equal pixels are compared",
    )
    flips: bool = Field(True, description="random horizontal and vertical flips of crops")

    @model_validator(mode="after")
    def _check_schedule(self):
        steps = self.tenth_from
        if (self.schedule == "steps") != bool(steps):
            raise ValueError(
                f"tenth_from = {steps}: needs one step or more with `schedule: steps`, and none with "
                f"another; the schedule is {self.schedule!r}"
            )
        if steps != sorted(set(steps)) or steps[-1:] >= [self.steps]:
            raise ValueError(
                f"tenth_from = {steps}: must be ascending, without repetition, and end below steps = "
                f"{self.steps}"
            )
        return self

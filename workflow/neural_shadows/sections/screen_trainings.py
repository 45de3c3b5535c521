"""`screen_trainings`: how networks that answer whole frames learn (Datta et al. 2022, 3.3)."""

from typing import Annotated, Literal

from pydantic import Field, model_validator

from neural_shadows.settings.base import Model, Text, by_kind


class Squeeze(Model):
    """SqueezeNet 1.1, after its first ReLU and after fire3."""

    net: Literal["squeeze"] = Field(
        "squeeze",
        description="`squeeze`: by metrics.lpips.trunk, if metrics.lpips.net is squeeze; else none",
    )


class Vgg19(Model):
    """VGG-19, relu2_2: the paper's."""

    net: Literal["vgg19"] = Field(description="`vgg19`, the paper's")
    trunk: Text = Field(description="local weights file of torchvision's vgg19")


class NoPerceptual(Model):
    """L1 alone."""

    net: Literal["none"] = Field(description="`none`: L1 alone")


class ScreenTraining(Model):
    """Crops of training frames, and what is learnt of them."""

    optimiser: Literal["adam", "muon"] = Field(
        "adam", description="`adam`, or `muon` for all convolutions but the first and the last"
    )
    steps: int = Field(ge=1, description="optimiser steps")
    crops: int = Field(ge=1, le=1024, description="crops of a step")
    crop: int = Field(
        ge=2, le=4096, description="side of a crop in pixels; of a smaller frame its whole side"
    )
    learning_rate: float = Field(gt=0, le=1, description="the optimiser's rate (at its start)")
    adam_rate: float = Field(0.003, gt=0, le=1, description="with muon, Adam's rate, of all else")
    schedule: Literal["constant", "cosine", "steps"] = Field(
        "cosine", description="of the rate: constant, cosine to zero, or a tenth from some steps on"
    )
    tenth_from: list[Annotated[int, Field(ge=1)]] = Field(
        [], description="with `steps`, from each of which the rate is a tenth of that before"
    )
    alpha: float = Field(0.9, ge=0, le=1, description="weight of L1; the rest is perceptual's")
    perceptual: by_kind("net", Squeeze, Vgg19, NoPerceptual, default="squeeze") = Field(
        Squeeze(), description="the distance between pretrained features"
    )
    perturbation: float = Field(
        3.0, ge=0, le=100, description="weight of the loss against a twin's output; 0 for none"
    )
    perturbation_from: float = Field(
        0.0, ge=0, lt=1, description="share of the steps that are done before that loss has a part"
    )
    aligned: bool = Field(
        False,
        description="whether the twin's output is looked up where it shows what the frame does; else "
        "pixels are compared as they lie",
    )
    flips: bool = Field(True, description="whether crops are mirrored and turned over at random")

    @model_validator(mode="after")
    def _check_schedule(self):
        places = self.tenth_from
        if (self.schedule == "steps") != bool(places):
            raise ValueError(
                f"tenth_from = {places}: goes with `schedule: steps`, and that needs a step or more; "
                f"the schedule is {self.schedule!r}"
            )
        if places != sorted(set(places)) or places[-1:] >= [self.steps]:
            raise ValueError(
                f"tenth_from = {places}: must grow from each to the next, and end below steps = "
                f"{self.steps}"
            )
        return self

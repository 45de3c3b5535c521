"""`metrics`: settings of image metrics."""

from typing import Literal

from pydantic import Field

from neural_shadows.settings.base import Model


class LpipsNetwork(Model):
    """The pretrained network inside LPIPS."""

    net: Literal["alex", "squeeze", "vgg"] = Field("alex", description="LPIPS's network")
    trunk: str | None = Field(
        None, description="local weights file of that network; default: downloaded from torchvision"
    )


class Metrics(Model):
    """Image metrics."""

    lpips: LpipsNetwork = Field(LpipsNetwork(), description="the learned perceptual metric")

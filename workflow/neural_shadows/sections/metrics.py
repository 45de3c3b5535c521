"""`metrics`: how frames are compared."""

from typing import Literal

from pydantic import Field

from neural_shadows.settings.base import Model


class LpipsTrunk(Model):
    """The pretrained network inside LPIPS."""

    net: Literal["alex", "squeeze", "vgg"] = Field("alex", description="LPIPS's network")
    trunk: str | None = Field(
        None, description="local weights file of that network; without it torchvision's is fetched"
    )


class Metrics(Model):
    """Image metrics."""

    lpips: LpipsTrunk = Field(LpipsTrunk(), description="the learned perceptual metric")

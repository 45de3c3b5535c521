"""`rendering`, `metrics` and `frame_times`: how methods are compared."""

from typing import Literal

from pydantic import Field

from neural_shadows.config.base import Model


class Rendering(Model):
    """Frames and viewpoints of all evaluations [4.1]."""

    width: int = Field(ge=64, le=8192, description="pixels")
    height: int = Field(ge=64, le=8192, description="pixels")
    views_per_set: int = Field(ge=1, le=1_000_000, description="viewpoints in each view set")
    batch: int = Field(ge=1, description="viewpoints of a set that one job renders")
    held_out_views: int = Field(8, ge=1, le=10_000, description="of a set, to find depth biases on")
    reference: Literal["exact", "shadow_map"] = Field(
        "exact", description="a shadow ray per pixel, or the thesis's 32768² shadow map"
    )


class LpipsTrunk(Model):
    """The pretrained network inside LPIPS."""

    net: Literal["alex", "squeeze", "vgg"] = Field("alex", description="LPIPS's network")
    trunk: str | None = Field(
        None, description="local weights file of that network; without it torchvision's is fetched"
    )


class Metrics(Model):
    """Image metrics."""

    lpips: LpipsTrunk = Field(LpipsTrunk(), description="the learned perceptual metric")


class FrameTimes(Model):
    """How frame times are measured [4.4.1]."""

    width: int = Field(1200, ge=64, le=8192, description="pixels")
    height: int = Field(800, ge=64, le=8192, description="pixels")
    repeats: int = Field(15, ge=3, le=10_000, description="timed frames of each method")

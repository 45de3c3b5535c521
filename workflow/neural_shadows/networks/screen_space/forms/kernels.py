"""Kernel Predicting Neural Shadow Maps (Hu et al. 2025)."""

from typing import Any, Literal

from pydantic import Field, field_validator

from neural_shadows.frames.feature_names import base_of, channels_of
from neural_shadows.networks.screen_space.kernel_widths import kernel_convolutions
from neural_shadows.networks.screen_space.widths import Convolution
from neural_shadows.networks.settings.screen_space import UnetOfSums


class Settings(UnetOfSums):
    """Kernel Predicting Neural Shadow Maps: kernels of each pixel."""

    form: Literal["kernels"] = Field(
        description="`kernels` that filter one of its features, a base"
    )
    filters: int = Field(
        4, ge=1, le=6, description="5 × 5 kernels of a pixel, each twice as wide as the one before"
    )
    ends: Literal["half", "full"] = Field(
        "half",
        description="the first level: `half` the frame's size, 2 × 2 pixels as channels and kernels "
        "enlarged bilinearly; `full`, the frame's own",
    )

    @field_validator("features")
    @classmethod
    def _check_base(cls, features: list[str]) -> list[str]:
        base_of(features)
        return features


def convolutions(settings: Settings) -> list[Convolution]:
    channels, ends = channels_of(settings.features), settings.ends
    return kernel_convolutions("kernels", settings.widths, channels, settings.filters, ends)


def network(settings: Settings) -> Any:
    from neural_shadows.networks.screen_space.kernel_unet import KernelUnet

    return KernelUnet(**settings.model_dump())

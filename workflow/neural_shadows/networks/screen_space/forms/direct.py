"""Visibility by the network of kernels (Hu et al. 2025)."""

from typing import Any, Literal

from pydantic import Field

from neural_shadows.frames.feature_names import channels_of
from neural_shadows.networks.screen_space.kernel_widths import kernel_convolutions
from neural_shadows.networks.screen_space.widths import Convolution
from neural_shadows.networks.settings.screen_space import UnetOfSums


class Settings(UnetOfSums):
    """The network of kernels with visibility itself for its output."""

    form: Literal["direct"] = Field(description="`direct`: visibility instead of kernels")


def convolutions(settings: Settings) -> list[Convolution]:
    channels = channels_of(settings.features)
    return kernel_convolutions("direct", settings.widths, channels, filters=0)


def network(settings: Settings) -> Any:
    from neural_shadows.networks.screen_space.kernel_unet import KernelUnet

    return KernelUnet(**settings.model_dump())

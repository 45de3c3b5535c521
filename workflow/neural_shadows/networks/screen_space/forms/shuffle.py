"""The trimmed network over pixel squares (Datta et al. 2022, 3.5)."""

from typing import Any, Literal

from pydantic import Field

from neural_shadows.frames.feature_names import channels_of
from neural_shadows.networks.screen_space import widths as counts
from neural_shadows.networks.settings.screen_space import Trimmed


class Settings(Trimmed):
    """The trimmed network over 2 × 2 pixels as channels."""

    form: Literal["shuffle"] = Field(description="`shuffle`, the paper's fast form")


def convolutions(settings: Settings) -> list[counts.Convolution]:
    channels = channels_of(settings.features)
    return counts.convolutions("shuffle", settings.widths, channels)


def network(settings: Settings) -> Any:
    from neural_shadows.networks.screen_space.exponent_unet import trimmed_network

    return trimmed_network(**settings.model_dump())

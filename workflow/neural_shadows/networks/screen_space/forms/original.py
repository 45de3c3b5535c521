"""Neural Shadow Mapping's network before trimming (Datta et al. 2022, S4.1)."""

from typing import Any, Literal

from pydantic import Field

from neural_shadows.frames.feature_names import channels_of
from neural_shadows.networks.screen_space import widths as counts
from neural_shadows.networks.settings.screen_space import AnyScreenNetwork, Channels


class Settings(AnyScreenNetwork):
    """The network before trimming: max pool, concatenation, transposed convolutions."""

    form: Literal["original"] = Field(description="`original`: two 3 × 3 convolutions a level")
    widths: list[Channels] = Field(
        min_length=2, max_length=8, description="channels of each level, from the finest"
    )


def convolutions(settings: Settings) -> list[counts.Convolution]:
    channels = channels_of(settings.features)
    return counts.convolutions("original", settings.widths, channels)


def network(settings: Settings) -> Any:
    from neural_shadows.networks.screen_space.shadow_unet import ShadowUnet

    return ShadowUnet(**settings.model_dump())

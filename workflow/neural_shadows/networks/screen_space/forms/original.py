"""Neural Shadow Mapping's network before trimming (Datta et al. 2022, S4.1)."""

from typing import Literal

from pydantic import Field

from neural_shadows.networks.screen_space.trimmed import convolutions, network
from neural_shadows.networks.settings.screen_space import AnyScreenNetwork, Channels


class Settings(AnyScreenNetwork):
    """The network before trimming: max pool, concatenation, transposed convolutions."""

    form: Literal["original"] = Field(description="`original`: two 3 × 3 convolutions a level")
    widths: list[Channels] = Field(
        min_length=2, max_length=8, description="channels of each level, from the finest"
    )

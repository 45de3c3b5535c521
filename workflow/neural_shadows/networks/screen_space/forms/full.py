"""Neural Shadow Mapping's trimmed network, full size (Datta et al. 2022, 3.5)."""

from typing import Literal

from pydantic import Field

from neural_shadows.networks.screen_space.trimmed import convolutions, network
from neural_shadows.networks.settings.screen_space import Channels, Trimmed


class Settings(Trimmed):
    """The trimmed network at the frame's own size."""

    form: Literal["full"] = Field(description="`full`")
    pool: Literal["average", "max"] = Field("average", description="on the way down")
    first_skip: bool = Field(False, description="a skip at the frame's own size, too")
    extraction: Channels | None = Field(
        None, description="hidden channels of a learned reduction of the features to four"
    )

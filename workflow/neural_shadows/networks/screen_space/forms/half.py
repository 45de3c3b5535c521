"""The trimmed network at half the resolution (Datta et al. 2022, 3.5)."""

from typing import Literal

from pydantic import Field

from neural_shadows.networks.screen_space.trimmed import convolutions, network
from neural_shadows.networks.settings.screen_space import Trimmed


class Settings(Trimmed):
    """The trimmed network over frames of half the resolution."""

    form: Literal["half"] = Field(description="`half`, frames of half the resolution")

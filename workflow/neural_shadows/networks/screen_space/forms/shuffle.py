"""The trimmed network over pixel squares (Datta et al. 2022, 3.5)."""

from typing import Literal

from pydantic import Field

from neural_shadows.networks.screen_space.trimmed import convolutions, network
from neural_shadows.networks.settings.screen_space import Trimmed


class Settings(Trimmed):
    """The trimmed network over 2 × 2 pixels as channels."""

    form: Literal["shuffle"] = Field(description="`shuffle`, the paper's fast form")

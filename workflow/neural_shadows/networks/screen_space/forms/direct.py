"""Visibility by the network of kernels (Hu et al. 2025)."""

from typing import Literal

from pydantic import Field

from neural_shadows.networks.screen_space.kernel_widths import convolutions, network
from neural_shadows.networks.settings.screen_space import UnetOfSums


class Settings(UnetOfSums):
    """The network of kernels with visibility itself for its output."""

    form: Literal["direct"] = Field(description="`direct`: visibility instead of kernels")

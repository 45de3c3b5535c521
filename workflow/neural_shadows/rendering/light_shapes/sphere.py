"""A spherical light."""

from typing import Literal

from pydantic import Field

from neural_shadows.rendering.light_shape import LightShape


class Settings(LightShape):
    """A sphere: from each point a disc across the direction to its centre."""

    shape: Literal["sphere"] = Field(description="`sphere`: `radii` are its radii")

"""A rectangular panel of light."""

from typing import Annotated, Literal

import numpy as np
from pydantic import Field, model_validator

from neural_shadows.rendering.light_shape import LightShape


class Settings(LightShape):
    """A panel that shines to both sides, such as a lamp below a ceiling."""

    shape: Literal["rectangle"] = Field(
        description="`rectangle`: `radii` are halves of its longer side"
    )
    aspect: float = Field(1.0, ge=0.01, le=1, description="its shorter side, in longer sides")
    facing: Annotated[list[float], Field(min_length=3, max_length=3)] = Field(
        [0.0, -1.0, 0.0],
        description="its normal in the scene's axes, y up; the longer side is level, along x if the "
        "panel is level",
    )

    @model_validator(mode="after")
    def _check(self):
        if not any(self.facing):
            raise ValueError("facing: [0, 0, 0] is no direction. Give a normal")
        return self

    def corners(self):
        normal = np.array(self.facing, np.float64) / np.linalg.norm(self.facing)
        level = np.array([normal[2], 0.0, -normal[0]])  # up × normal
        along = level / np.linalg.norm(level) if level.any() else np.array([1.0, 0.0, 0.0])
        across = self.aspect * np.cross(normal, along)
        return np.array([along + across, along - across, -along - across, -along + across])

"""`samplings`: training rays."""

from typing import Literal

from pydantic import Field, model_validator

from neural_shadows.settings.base import Model, PowerOfTwo


class Sampling(Model):
    """Sampling of training rays [3.4]."""

    sampler: Literal["poisson_quadtree", "uniform_quadtree", "uniform"] = Field(
        description="sampling method of table 4.1"
    )
    domain: Literal["sphere", "hemisphere", "light"] = Field(
        "sphere",
        description="range of view directions: all, above the horizon, or the scene's lights",
    )
    directions: int = Field(ge=1, le=1_000_000, description="number of view directions")
    points_per_direction: int = Field(
        ge=1, le=10_000_000, description="rays per direction, m [3.4.2]"
    )
    silhouette_resolution: PowerOfTwo = Field(
        128, ge=8, le=4096, description="texels along a side of the silhouette map"
    )
    min_quad: PowerOfTwo = Field(1, ge=1, le=4096, description="side of the smallest quad, texels")
    shards: int = Field(2, ge=1, le=10_000, description="number of files, and jobs, for rays")

    @model_validator(mode="after")
    def _check(self):
        if self.min_quad > self.silhouette_resolution:
            raise ValueError(
                f"min_quad = {self.min_quad}: must not exceed silhouette_resolution "
                f"({self.silhouette_resolution})"
            )
        if self.shards > self.directions:
            raise ValueError(
                f"shards = {self.shards}: must not exceed directions ({self.directions})"
            )
        return self

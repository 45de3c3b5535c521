"""`frame_sets.views`: views of meshes under a sun."""

from typing import Literal

from pydantic import Field

from neural_shadows.settings.base import Model


class Views(Model):
    """Views of meshes under a sun, of all evaluations on meshes [4.1]."""

    width: int = Field(ge=64, le=8192, description="pixels")
    height: int = Field(ge=64, le=8192, description="pixels")
    views_per_set: int = Field(ge=1, le=1_000_000, description="viewpoints per view set")
    batch: int = Field(ge=1, description="viewpoints per view set and job")
    held_out_views: int = Field(
        8,
        ge=1,
        le=10_000,
        description="viewpoints per view set for choosing depth biases, outside all tables",
    )
    reference: Literal["exact", "shadow_map"] = Field(
        "exact",
        description="reference shadows: one shadow ray per pixel, or the thesis's 32768² shadow map",
    )

"""`screen_profiles`: times of screen-space networks by level."""

from pydantic import Field

from neural_shadows.settings.base import Model


class ScreenProfiles(Model):
    """Frame size and repetitions of a profile (Datta et al. 2022, S3)."""

    width: int = Field(2048, ge=16, le=8192, description="pixels")
    height: int = Field(1024, ge=16, le=8192, description="pixels")
    repeats: int = Field(10, ge=3, le=10_000, description="timed frames, after three warm-ups")
    product_size: int = Field(
        2048,
        ge=16,
        le=8192,
        description="rows of the square matrices whose product gives the peak throughput",
    )

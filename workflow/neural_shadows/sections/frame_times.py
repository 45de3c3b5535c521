"""`frame_times`: measurement of frame times."""

from pydantic import Field

from neural_shadows.settings.base import Model


class FrameTimes(Model):
    """Measurement of frame times [4.4.1]."""

    width: int = Field(1200, ge=64, le=8192, description="pixels")
    height: int = Field(800, ge=64, le=8192, description="pixels")
    repeats: int = Field(7, ge=3, le=10_000, description="timed frames per method")

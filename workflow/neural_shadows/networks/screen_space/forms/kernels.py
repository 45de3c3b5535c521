"""Kernel Predicting Neural Shadow Maps (Hu et al. 2025)."""

from typing import Literal

from pydantic import Field, field_validator, model_validator

from neural_shadows.frames.feature_names import GUIDE, base_of
from neural_shadows.networks.screen_space.kernel_widths import convolutions, network
from neural_shadows.networks.settings.screen_space import UnetOfSums


class Settings(UnetOfSums):
    """Kernel Predicting Neural Shadow Maps: kernels of each pixel."""

    form: Literal["kernels"] = Field(
        description="`kernels` that filter one of its features, a base"
    )
    filters: int = Field(
        4, ge=1, le=6, description="5 × 5 kernels of a pixel, each twice as wide as the one before"
    )
    ends: Literal["half", "full"] = Field(
        "half",
        description="the first level: `half` the frame's size, 2 × 2 pixels as channels and kernels "
        "enlarged bilinearly; `full`, the frame's own",
    )

    edge: float | None = Field(
        None,
        gt=0,
        le=10,
        description="largest difference of the feature `log_d` between a kernel's pixel and its taps, so that "
        "no shadow goes across a silhouette; default: any",
    )

    @field_validator("features")
    @classmethod
    def _check_base(cls, features: list[str]) -> list[str]:
        base_of(features)
        return features

    @model_validator(mode="after")
    def _check_edge(self):
        if self.edge is not None and GUIDE not in self.features:
            raise ValueError(f"edge: needs the feature {GUIDE!r}. Add it to `features`")
        return self

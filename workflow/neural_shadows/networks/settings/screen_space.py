"""Common settings of screen-space networks."""

from typing import Annotated, ClassVar, Literal

from pydantic import Discriminator, Field, Tag, field_validator, model_validator

from neural_shadows.frames.feature_names import FEATURES
from neural_shadows.settings.base import Model, not_among

BEHIND = "behind"
# What the viewer's shaders evaluate (workflow/report/soft_viewer/shaders); first the default.
SHADED = {
    "form": ("kernels", "shuffle", "half", "full", "direct"),
    "ends": ("half",),
    "answer": ("visibility",),
}
Channels = Annotated[int, Field(ge=1, le=4096)]
# Mid and out: outputs of the 3 × 3 convolution, and of the 1 × 1 behind it.
Pair = Annotated[list[Channels], Field(min_length=2, max_length=2)]
Width = Annotated[
    Annotated[Channels, Tag("Number")] | Annotated[Pair, Tag("Pair")],
    Discriminator(lambda value: "Pair" if isinstance(value, list) else "Number"),
]


class AnyScreenNetwork(Model):
    """Settings of all forms; `form` is the name of a form's file."""

    crops_in_pairs: ClassVar[bool] = False  # for batch norms over two crops

    features: list[str] = Field(
        min_length=1, description="input channels: names in frames/feature_names.py"
    )

    @field_validator("features")
    @classmethod
    def _check_features(cls, features: list[str]) -> list[str]:
        for name in features:
            if name not in FEATURES:
                raise ValueError(not_among(name, FEATURES))
            if features.count(name) > 1:
                raise ValueError(f"{name!r} is listed twice. List it once.")
        return features


class Trimmed(AnyScreenNetwork):
    """Two convolutions a level, sums for skips, bilinear enlargement.

    Of 3 × 3 and of 1 × 1 pixels.
    """

    widths: list[Width] = Field(
        min_length=2,
        max_length=8,
        description="channels of each level, from the finest; [mid, out] for different "
        "convolutions",
    )
    answer: Literal["visibility", "exponent"] = Field(
        "visibility",
        description="`exponent`: visibility exp(−α `behind`) with a learned α, compared in logarithms",
    )

    @model_validator(mode="after")
    def _check_answer(self):
        if self.answer == "exponent" and BEHIND not in self.features:
            raise ValueError(
                f"features: {', '.join(self.features)}: no {BEHIND!r}, which answer: exponent needs. "
                "Add it."
            )
        return self


class UnetOfSums(AnyScreenNetwork):
    """Two convolutions with batch norms a level, sums for skips.

    Of 3 × 3 pixels; the first level has 2 × 2 pixels as channels.
    """

    crops_in_pairs: ClassVar[bool] = True

    widths: list[Channels] = Field(
        min_length=2,
        max_length=8,
        description="channels of each level, from half the frame's size (with `ends: full` its own)",
    )

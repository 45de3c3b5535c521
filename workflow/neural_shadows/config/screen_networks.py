"""`screen_networks`: networks that answer whole frames, by form (Datta et al. 2022, 3.5; Hu et al.
2025, 4.2.1).
"""

from typing import Annotated, Literal

from pydantic import Discriminator, Field, Tag, field_validator, model_validator

from neural_shadows.config.base import Model, by_kind, not_among
from neural_shadows.frames.feature_names import FEATURES, base_of

BEHIND = "behind"
Channels = Annotated[int, Field(ge=1, le=4096)]
# Mid and out: what the 3 × 3 convolution leaves, and the 1 × 1 behind it.
Pair = Annotated[list[Channels], Field(min_length=2, max_length=2)]
Width = Annotated[
    Annotated[Channels, Tag("Number")] | Annotated[Pair, Tag("Pair")],
    Discriminator(lambda value: "Pair" if isinstance(value, list) else "Number"),
]


class AnyScreenNetwork(Model):
    """What all forms have."""

    features: list[str] = Field(
        min_length=1, description="what it is told of a pixel: names in frames/feature_names.py"
    )

    @field_validator("features")
    @classmethod
    def _check_features(cls, features: list[str]) -> list[str]:
        for name in features:
            if name not in FEATURES:
                raise ValueError(not_among(name, FEATURES))
            if features.count(name) > 1:
                raise ValueError(f"{name!r} is there twice; should be there once")
        return features


class Trimmed(AnyScreenNetwork):
    """A 3 × 3 and a 1 × 1 convolution a level, sums for skips, bilinear enlargement."""

    widths: list[Width] = Field(
        min_length=2,
        max_length=8,
        description="channels of each level, from the finest; [mid, out] where its two "
        "convolutions differ",
    )
    answer: Literal["visibility", "exponent"] = Field(
        "visibility",
        description="`exponent`: visibility is exp(−α `behind`) and it learns α, in logarithms",
    )

    @model_validator(mode="after")
    def _check_answer(self):
        if self.answer == "exponent" and BEHIND not in self.features:
            raise ValueError(
                f"features: an exponent is multiplied by {BEHIND!r}, which is not there; there is "
                f"{', '.join(self.features)}"
            )
        return self


class FullNetwork(Trimmed):
    """The trimmed network at the frame's own size."""

    form: Literal["full"] = Field(description="`full`")
    pool: Literal["average", "max"] = Field("average", description="on the way down")
    first_skip: bool = Field(False, description="a skip at the frame's own size, too")
    extraction: Channels | None = Field(
        None, description="hidden channels of a learned reduction of the features to four"
    )


class SmallerNetwork(Trimmed):
    """Without the level of the frame's own size: 2 × 2 pixels as channels, or half the size."""

    form: Literal["shuffle", "half"] = Field(
        description="`shuffle`, the paper's fast form; `half`, frames of half the resolution"
    )


class OriginalNetwork(AnyScreenNetwork):
    """The network before trimming: max pool, concatenation, transposed convolutions."""

    form: Literal["original"] = Field(description="`original`: two 3 × 3 convolutions a level")
    widths: list[Channels] = Field(
        min_length=2, max_length=8, description="channels of each level, from the finest"
    )


class UnetOfSums(AnyScreenNetwork):
    """2 × 2 pixels as channels, two 3 × 3 convolutions with batch norms a level, sums for skips."""

    widths: list[Channels] = Field(
        min_length=2,
        max_length=8,
        description="channels of each level, from half the frame's size (with `ends: full` its own)",
    )


class KernelNetwork(UnetOfSums):
    """Kernels of each pixel, which filter a base: Kernel Predicting Neural Shadow Maps."""

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

    @field_validator("features")
    @classmethod
    def _check_base(cls, features: list[str]) -> list[str]:
        base_of(features)
        return features


class DirectNetwork(UnetOfSums):
    """The same network with visibility itself for its answer, which it is compared with."""

    form: Literal["direct"] = Field(description="`direct`: visibility instead of kernels")


ScreenNetwork = by_kind(
    "form", FullNetwork, SmallerNetwork, OriginalNetwork, KernelNetwork, DirectNetwork
)

"""`claims`: what the thesis concludes, and the data that tests it."""

from typing import Annotated, Literal

from pydantic import Field, model_validator

from neural_shadows.config.base import Model, Name


class AnyClaim(Model):
    """What all claims have."""

    section: str = Field(pattern=r"^[1-9](\.[1-9])*$", description="of the thesis, as 4.2.1")
    statement: str = Field(min_length=1, description="one sentence, as the thesis draws it")


Pair = Annotated[list[str], Field(min_length=2, max_length=2)]
Pairs = Annotated[
    list[Pair], Field(min_length=1, description="comparisons, the claimed winner first")
]


class BetterClaim(AnyClaim):
    """Methods compared by the mean over views of an image metric."""

    kind: Literal["better"] = Field(description="`better`")
    evaluations: list[Name] = Field(
        min_length=1, description="names in `evaluations`, each method in one of them"
    )
    pairs: Pairs
    metric: Literal["lpips", "psnr", "ssim", "flip", "shadow_error"] = Field(
        "lpips", description="an image metric; FLIP takes LPIPS's place where its trunk is missing"
    )


class MoreClaim(AnyClaim):
    """More of one kind of error than of another, for each method."""

    kind: Literal["more"] = Field(description="`more`")
    evaluations: list[Name] = Field(
        min_length=1, description="names in `evaluations`, each method in one of them"
    )
    methods: list[str] = Field(min_length=1, description="methods of the evaluations")
    more: Literal["false_shadow", "light_leak"] = Field(description="the larger error")
    less: Literal["false_shadow", "light_leak"] = Field(description="the smaller error")

    @model_validator(mode="after")
    def _check_errors(self):
        if self.more == self.less:
            raise ValueError(f"more = {self.more!r}: must be another error than `less`")
        return self


class LowerLossClaim(AnyClaim):
    """Networks compared by the end of their training loss."""

    kind: Literal["lower_loss"] = Field(description="`lower_loss`")
    pairs: Pairs


class FrameTimeClaim(AnyClaim):
    """The ratio of two methods' median frame times, within bounds."""

    kind: Literal["frame_time"] = Field(description="`frame_time`")
    table: str = Field(description="a table of `frame_times` in `tables`")
    pairs: Annotated[
        list[Pair],
        Field(min_length=1, description="methods of one scene; the first's time over the second's"),
    ]
    at_least: float | None = Field(None, gt=0, lt=1e6, description="least ratio")
    at_most: float | None = Field(None, gt=0, lt=1e6, description="largest ratio")

    @model_validator(mode="after")
    def _check_bounds(self):
        if self.at_least is None and self.at_most is None:
            raise ValueError("a claim on frame_time needs `at_least`, `at_most`, or both")
        if None not in (self.at_least, self.at_most) and self.at_least >= self.at_most:
            raise ValueError(
                f"at_least = {self.at_least:g}: must be less than at_most ({self.at_most:g})"
            )
        return self


Claim = Annotated[
    BetterClaim | MoreClaim | LowerLossClaim | FrameTimeClaim, Field(discriminator="kind")
]

"""`claims`: what the thesis concludes, and the data that tests it."""

from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import Field, model_validator

from neural_shadows.config.base import Model, Name, by_kind, check_among, name_in
from neural_shadows.config.tables import Row, RowSettings, row_of, rows_of
from neural_shadows.evaluation.method_names import experiment_of, is_classic

if TYPE_CHECKING:
    from neural_shadows.config.whole import Config


class AnyClaim(Model):
    """What all claims have."""

    section: str = Field(pattern=r"^[1-9](\.[1-9])*$", description="of the thesis, as 4.2.1")
    statement: str = Field(min_length=1, description="one sentence, as the thesis draws it")


Pair = Annotated[list[str], Field(min_length=2, max_length=2)]
Pairs = Annotated[list[Pair], Field(min_length=1)]


class BetterClaim(AnyClaim):
    """Methods compared by the mean over views of an image metric."""

    kind: Literal["better"] = Field(description="`better`")
    pairs: Pairs = Field(description="methods, one of them a network; the claimed winner first")
    metric: Literal["lpips", "psnr", "ssim", "flip", "shadow_error"] = Field(
        "lpips", description="an image metric; FLIP takes LPIPS's place where its trunk is missing"
    )


class LargerErrorClaim(AnyClaim):
    """More of one kind of error than of another, for each network."""

    kind: Literal["larger_error"] = Field(description="`larger_error`")
    methods: list[str] = Field(min_length=1, description="networks")
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
    pairs: list[Annotated[list[name_in("experiments")], Field(min_length=2, max_length=2)]] = Field(
        min_length=1, description="experiments, the claimed winner first"
    )


class FrameTimeClaim(AnyClaim):
    """The ratio of two methods' median frame times, within bounds."""

    kind: Literal["frame_time"] = Field(description="`frame_time`")
    table: Name = Field(description="a table of `frame_times` in `tables`")
    pairs: Pairs = Field(description="methods of one scene; the first's time over the second's")
    at_least: float | None = Field(None, gt=0, lt=1e6, description="least ratio")
    at_most: float | None = Field(None, gt=0, lt=1e6, description="largest ratio")

    @model_validator(mode="after")
    def _check_bounds(self):
        if self.at_least is None and self.at_most is None:
            raise ValueError("a claim on frame_time needs `at_least`, `at_most`, or both")
        return self


Claim = by_kind("kind", BetterClaim, LargerErrorClaim, LowerLossClaim, FrameTimeClaim)


def compared(claim: AnyClaim) -> list[list[str]]:
    """The methods of a claim that are compared with each other, or each alone."""
    return getattr(claim, "pairs", None) or [[method] for method in claim.methods]


def rows_of_claim(config: "Config", methods: list[str]) -> list[Row]:
    """Methods that a claim compares as rows: a shadow map's scene is the network's beside it."""
    names = [experiment_of(method) for method in methods]
    scenes = [config.experiments[name].scene for name in names if name in config.experiments]
    rows = []
    for name, method in zip(names, methods):
        row = RowSettings(method=name, bias=None if name == method else "held_out")
        experiment = config.experiments.get(name)
        rows.append(row_of(config, experiment.scene if experiment else scenes[0], row))
    return rows


def check(config: "Config") -> None:
    """Check names in claims: methods are networks, or shadow maps compared with one."""
    timed = [name for name, table in config.tables.items() if table.kind == "frame_times"]
    for name, claim in config.claims.items():
        if isinstance(claim, FrameTimeClaim):
            check_among(f"claims.{name}.table", claim.table, timed)
        key = f"claims.{name}.{'pairs' if hasattr(claim, 'pairs') else 'methods'}"
        for methods in compared(claim):
            for method in methods:
                if not is_classic(method):
                    check_among(key, experiment_of(method), config.experiments)
            if all(map(is_classic, methods)):
                raise ValueError(f"{key}: {methods}: one of them should be an experiment")
            if len(set(methods)) < len(methods):
                raise ValueError(f"{key}: {methods[0]!r} is compared with itself")
            if isinstance(claim, FrameTimeClaim):
                scene = rows_of_claim(config, methods)[0]["scene"]
                rows = [row for row in rows_of(config, claim.table) if row["scene"] == scene]
                for method in methods:
                    check_among(key, method, [row["method"] for row in rows])

"""`claims`: what the thesis concludes, and the data that tests it."""

from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import Field, model_validator

from neural_shadows.config.base import Model, Name, by_kind, instead
from neural_shadows.config.tables import FrameTimesTable, method_key
from neural_shadows.evaluation.method_names import experiment_of, is_shadow_map

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
    pairs: Pairs = Field(description="experiments, the claimed winner first")


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
        if None not in (self.at_least, self.at_most) and self.at_least >= self.at_most:
            raise ValueError(
                f"at_least = {self.at_least:g}: must be less than at_most ({self.at_most:g})"
            )
        return self


Claim = by_kind("kind", BetterClaim, LargerErrorClaim, LowerLossClaim, FrameTimeClaim)


def compared(claim: AnyClaim) -> list[list[str]]:
    """The methods of a claim that are compared with each other, or each alone."""
    return getattr(claim, "pairs", None) or [[method] for method in claim.methods]


def scenes_of(config: "Config", methods: list[str]) -> dict[str, str]:
    """The scene of each of the methods compared: a network's own, a shadow map's the network's."""
    networks = {
        method: config.experiments[name].scene
        for method in methods
        if (name := experiment_of(method)) in config.experiments
    }
    return {method: networks.get(method, next(iter(networks.values()))) for method in methods}


def check(config: "Config") -> None:
    """Check names in claims: methods are networks, or shadow maps compared with one."""
    for name, claim in config.claims.items():
        key = f"claims.{name}.{'pairs' if hasattr(claim, 'pairs') else 'methods'}"
        for methods in compared(claim):
            for method in methods:
                _check_method(config, key, claim, method)
            if all(map(is_shadow_map, methods)):
                raise ValueError(f"{key}: {methods}: one of them should be an experiment")
            if len(set(methods)) < len(methods):
                raise ValueError(
                    f"{key}: {methods[0]!r} is compared with itself; allowed: two methods"
                )
            if isinstance(claim, FrameTimeClaim):
                _check_timed(config, key, claim, methods)


def _check_method(config: "Config", key: str, claim: AnyClaim, method: str) -> None:
    of_loss = isinstance(claim, LowerLossClaim)
    known = method in config.experiments
    if not of_loss:
        known = known or experiment_of(method) in config.experiments or is_shadow_map(method)
    if not known:
        others = [] if of_loss else ["shadow_map_N"]
        raise ValueError(
            f"{key}: no such method: {instead(method, [*others, *config.experiments])}"
        )


def _check_timed(config: "Config", key: str, claim: FrameTimeClaim, methods: list[str]) -> None:
    table = config.tables.get(claim.table)
    if not isinstance(table, FrameTimesTable):
        tables = [name for name, other in config.tables.items() if other.kind == "frame_times"]
        raise ValueError(
            f"{key.removesuffix('.pairs')}.table: is no table of frame_times: {instead(claim.table, tables)}"
        )
    scene = scenes_of(config, methods)[methods[0]]
    timed = [method_key(config, row) for row in table.rows.get(scene, [])]
    if not set(methods) <= set(timed):
        raise ValueError(
            f"{key}: {methods}: must be timed together on one scene of {claim.table}; "
            f"{scene} has {', '.join(timed)}"
        )

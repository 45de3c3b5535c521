"""`claims`: what the thesis concludes, and the data that tests it."""

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import AfterValidator, Field, model_validator

from neural_shadows.config.base import Model, Name, by_kind, check_among, name_in
from neural_shadows.config.experiments import network_of
from neural_shadows.config.own_frames import OwnFrames
from neural_shadows.config.ratios import Ratio
from neural_shadows.config.screen_experiments import as_settings, differences
from neural_shadows.config.tables import Row, RowSettings, row_of, rows_of
from neural_shadows.evaluation.method_names import (
    is_classic,
    is_null,
    shadow_map_key,
    unbiased,
)
from neural_shadows.evaluation.soft_method_names import BASE, is_network
from neural_shadows.reports.claims.measured import WITHOUT_ROWS
from neural_shadows.reports.published import read_published

if TYPE_CHECKING:
    from neural_shadows.config.whole import Config

PUBLISHED_CSV = Path(__file__).parents[3] / "config" / "published.csv"


def _no_twins(values: list[Any]) -> list[Any]:
    for value in values:
        if values.count(value) > 1:
            raise ValueError(f"{value!r} is there twice; should be there once")
    return values


def _each_once(again: dict[str, list[str]]) -> dict[str, list[str]]:
    for name, others in again.items():
        _no_twins([name, *others])
    return again


class Needs(Model):
    """What a run needs to decide a claim; with less it is not comparable or undecided."""

    device: Literal["cuda", "cpu"] | None = Field(None, description="that all methods are timed on")
    seeds: int | None = Field(None, ge=1, le=100, description="trainings of each network")
    budget: float | None = Field(
        None,
        gt=0,
        le=1,
        description="share of the samples of its text; with less only what learning curves license",
    )
    mesh: Literal["thesis"] | None = Field(
        None, description="`thesis`: the thesis's meshes, and no others in their place"
    )
    trunk: Literal[True] | None = Field(
        None, description="a pretrained one, so that one of its networks has a perceptual loss"
    )


class AnyClaim(Model):
    """What all claims have."""

    text: Literal["thesis", "nsm", "kpnsm", "own"] = Field(
        "thesis",
        description="whose claim it is: the thesis's, Neural Shadow Mapping's (Datta et al. 2022), "
        "Kernel Predicting Neural Shadow Maps' (Hu et al. 2025), or this project's own, of methods "
        "that are not trained",
    )
    section: str = Field(
        "1",
        pattern=r"^S?[1-9](\.[0-9]+)*$",
        description="of that text, as 4.2.1; none of an own one",
    )
    statement: str = Field(min_length=1, description="one sentence, as the text draws it")
    needs: Needs = Field(Needs(), description="what a run needs to decide it")


Pair = Annotated[list[str], Field(min_length=2, max_length=2)]
Pairs = Annotated[list[Pair], Field(min_length=1)]
SoftRadii = list[Annotated[int, Field(ge=0)]]


class BetterClaim(AnyClaim):
    """Methods compared by image metrics, in all of which the claim is to hold."""

    kind: Literal["better"] = Field(description="`better`")
    pairs: Pairs = Field(description="methods, one of them a network; the claimed winner first")
    metrics: Annotated[
        list[Literal["lpips", "psnr", "ssim", "flip", "shadow_error"]], AfterValidator(_no_twins)
    ] = Field(
        ["lpips"],
        min_length=1,
        description="image metrics; FLIP takes LPIPS's place where its trunk is missing",
    )


class ViolationsClaim(AnyClaim):
    """Of each network, a violation of the lower bound shows more often than one of the upper."""

    kind: Literal["violations"] = Field(description="`violations`")
    methods: list[str] = Field(min_length=1, description="networks")


class LowerLossClaim(AnyClaim):
    """Networks compared by the end of their training loss."""

    kind: Literal["lower_loss"] = Field(description="`lower_loss`")
    pairs: list[Annotated[list[name_in("experiments")], Field(min_length=2, max_length=2)]] = Field(
        min_length=1, description="experiments, the claimed winner first"
    )


class FrameTimeClaim(AnyClaim):
    """The ratio of two methods' own median times, within bounds."""

    kind: Literal["frame_time"] = Field(description="`frame_time`")
    table: Name = Field(description="a table of `frame_times` in `tables`")
    pairs: Pairs = Field(description="methods of one scene; the first's time over the second's")
    at_least: float | None = Field(None, gt=0, lt=1e6, description="least ratio")
    at_most: float | None = Field(None, gt=0, lt=1e6, description="largest ratio")
    overhead_ms: float = Field(
        0.0,
        ge=0,
        lt=1e6,
        description="milliseconds of a frame beside the method, added to both own times",
    )

    @model_validator(mode="after")
    def _check_bounds(self):
        if self.at_least is None and self.at_most is None:
            raise ValueError("a claim on frame_time needs `at_least`, `at_most`, or both")
        return self


class PrintedClaim(AnyClaim):
    """What the thesis's own tables say, without a run: of pairs of rows, or of a row's equal."""

    kind: Literal["printed"] = Field(description="`printed`")
    table: str = Field(pattern=r"^4\.[1-7]$", description="the thesis's number of a table")
    pairs: Pairs | None = Field(None, description="rows of published.csv, the winner first")
    row: str | None = Field(None, description="a row of published.csv, for `equivalent_to`")
    equivalent_to: int | None = Field(
        None, ge=2, le=32768, description="texels of a side of the map that it is as good as"
    )
    metrics: Annotated[list[Literal["lpips", "psnr", "ssim"]], AfterValidator(_no_twins)] = Field(
        min_length=1, description="columns of published.csv, in all of which it is to hold"
    )

    @model_validator(mode="after")
    def _check_parts(self):
        parts = self.pairs is not None, self.row is not None, self.equivalent_to is not None
        if parts not in ((True, False, False), (False, True, True)):
            raise ValueError("a printed claim needs `pairs`, or `row` and `equivalent_to`")
        return self

    def rows(self) -> list[str]:
        """The rows of published.csv that it is tested on."""
        if self.pairs is None:
            return [self.row, shadow_map_key(self.equivalent_to)]
        return [row for pair in self.pairs for row in pair]


class SoftClaim(AnyClaim):
    """Methods for soft shadows, compared on the same frames."""

    table: Name = Field(description="a table of `soft_methods` or `soft_summary` in `tables`")
    again: Annotated[
        dict[Name, list[name_in("screen_experiments")]], AfterValidator(_each_once)
    ] = Field({}, description="by network, those that are the same, trained from other seeds")


class SoftBetterClaim(SoftClaim):
    """One method has a smaller error than another."""

    kind: Literal["soft_better"] = Field(description="`soft_better`")
    radii: SoftRadii | None = Field(
        None,
        min_length=1,
        description="as of `soft_equal_time`; without it the mean over all is compared",
    )
    pairs: Pairs = Field(description="methods of the table, the claimed winner first")
    metrics: Annotated[
        list[
            Literal[
                "mse_off_edges", "mse", "ssim", "l1", "light_leak", "false_shadow", "flip", "lpips"
            ]
        ],
        AfterValidator(_no_twins),
    ] = Field(
        ["mse_off_edges"],
        min_length=1,
        description="in all of which it is to hold; where `mse`, of all pixels, would have another "
        "verdict than `mse_off_edges`, of those without an edge of a surface, the evidence says so; "
        "`flip` and `lpips` are measured by the middle light alone",
    )


class SoftEqualTimeClaim(SoftClaim):
    """As many rays as fit into a method's time have a smaller squared error off edges than it."""

    kind: Literal["soft_equal_time"] = Field(description="`soft_equal_time`")
    radii: SoftRadii = Field(
        min_length=1,
        description="of the table's frame set, counted from 0, at all of which it is to hold",
    )
    methods: list[str] = Field(
        min_length=1, description="methods of the table that rays are to beat"
    )


class RatioClaim(AnyClaim):
    """Numbers of tables over each other, within bounds."""

    kind: Literal["ratio"] = Field(description="`ratio`")
    ratios: list[Ratio] = Field(min_length=1, description="all of which are to hold")
    networks: list[name_in("screen_experiments")] = Field(
        [], description="the trained networks that it is about"
    )
    again: Annotated[dict[Name, list[Name]], AfterValidator(_each_once)] = Field(
        {},
        description="by table, those with the same rows of networks that were trained from other seeds",
    )


class ProportionalClaim(AnyClaim):
    """A table's column is proportional to one of its columns rather than to another."""

    kind: Literal["proportional"] = Field(description="`proportional`")
    table: Name = Field(description="a name in `tables`")
    column: str = Field(min_length=1, description="of the table's CSV")
    to: str = Field(min_length=1, description="the column that it is claimed to follow")
    rather_than: str = Field(min_length=1, description="the column that it follows less")


Claim = by_kind(
    "kind",
    BetterClaim,
    ViolationsClaim,
    LowerLossClaim,
    FrameTimeClaim,
    PrintedClaim,
    SoftBetterClaim,
    SoftEqualTimeClaim,
    RatioClaim,
    ProportionalClaim,
)


def compared(claim: AnyClaim) -> list[list[str]]:
    """The methods of a claim that are compared with each other, or each alone."""
    if claim.kind in WITHOUT_ROWS:
        return []
    return getattr(claim, "pairs", None) or [[method] for method in claim.methods]


def methods_of(claim: SoftBetterClaim | SoftEqualTimeClaim) -> list[str]:
    """The methods of its table that a claim on soft shadows names."""
    return getattr(claim, "methods", None) or [m for pair in claim.pairs for m in pair]


def other_seeds(config: "Config", claim: SoftClaim | RatioClaim) -> Iterator[tuple[str, list[str]]]:
    """Networks of a claim, each with those that are the same, trained from other seeds.

    Of a claim on tables: with those in the tables that are `again` one in which it stands.
    """
    if isinstance(claim, SoftClaim):
        yield from claim.again.items()
        return
    for table, others in claim.again.items():
        for network in claim.networks:
            if network in _asked_in(config, table):
                yield network, [x for other in others for x in _same_in(config, network, other)]


def _asked_in(config: "Config", table: str) -> list[str]:
    """The methods or networks that a table names; none of a table of another kind."""
    return getattr(config.tables[table], "asked", [])


def _same_in(config: "Config", network: str, table: str) -> list[str]:
    """The networks of a table that are another but for their seeds, each once."""
    others = [
        x for x in _asked_in(config, table) if x in config.screen_experiments and x != network
    ]
    return [x for x in dict.fromkeys(others) if not differences(config, network, x)]


def networks_of_claim(config: "Config", claim: SoftClaim | RatioClaim) -> list[str]:
    """The trained networks of frames that a claim is about, those of other seeds among them."""
    soft = isinstance(claim, SoftClaim)
    named = [*filter(is_network, methods_of(claim))] if soft else [*claim.networks]
    named += [name for _, others in other_seeds(config, claim) for name in others]
    known = config.networks_by_scene
    return [x for name in named for x in (known[name].experiments if name in known else [name])]


def bases_of_claim(config: "Config", claim: SoftClaim) -> dict[str, str]:
    """By network of a claim the method that its base shadow is; without those that have none."""
    experiments = {
        name: config.screen_experiments[name] for name in networks_of_claim(config, claim)
    }
    features = {
        name: config.screen_networks[one.network].features for name, one in experiments.items()
    }
    return {name: base for name, some in features.items() for base in some if base.startswith(BASE)}


def rows_of_claim(config: "Config", methods: list[str]) -> list[Row]:
    """Methods that a claim compares as rows: one that is no network is on the network's scene."""
    names = [unbiased(method) for method in methods]
    scenes = [config.experiments[name].scene for name in names if name in config.experiments]
    rows = []
    for name, method in zip(names, methods):
        row = RowSettings(method=name, bias=None if name == method else "held_out")
        experiment = config.experiments.get(name)
        rows.append(row_of(config, experiment.scene if experiment else scenes[0], row))
    return rows


def check(config: "Config") -> None:
    """Check names in claims: methods are networks or compared with one, printed rows are there."""
    timed = [name for name, table in config.tables.items() if table.kind == "frame_times"]
    for name, claim in config.claims.items():
        if isinstance(claim, FrameTimeClaim):
            check_among(f"claims.{name}.table", claim.table, timed)
        if isinstance(claim, PrintedClaim):
            _check_printed(f"claims.{name}", claim)
        if isinstance(claim, SoftClaim):
            _check_soft(config, f"claims.{name}", claim)
        if isinstance(claim, ProportionalClaim):
            check_among(f"claims.{name}.table", claim.table, config.tables)
        for ratio in getattr(claim, "ratios", ()):
            check_among(f"claims.{name}.ratios.table", ratio.table, config.tables)
        for table, others in claim.again.items() if isinstance(claim, RatioClaim) else ():
            check_among(f"claims.{name}.again", table, [one.table for one in claim.ratios])
            for other in others:
                key = f"claims.{name}.again.{table}"
                check_among(key, other, config.tables)
                for network in claim.networks:
                    if network in _asked_in(config, table) and not _same_in(config, network, other):
                        raise ValueError(
                            f"{key}: {other!r} has no network that differs from {network!r} in "
                            "`seed` and `label` alone"
                        )
        if isinstance(claim, SoftClaim | RatioClaim):
            _check_seeds(config, f"claims.{name}.again", claim)
        key = f"claims.{name}.{'pairs' if hasattr(claim, 'pairs') else 'methods'}"
        for methods in compared(claim):
            _check_methods(config, key, methods, claim)
            if isinstance(claim, FrameTimeClaim):
                scene = rows_of_claim(config, methods)[0]["scene"]
                rows = [row for row in rows_of(config, claim.table) if row["scene"] == scene]
                for method in methods:
                    check_among(key, method, [row["method"] for row in rows])


def _check_methods(config: "Config", key: str, methods: list[str], claim: AnyClaim) -> None:
    names = [unbiased(method) for method in methods]
    for name, method in zip(names, methods):
        if is_null(name) and name != method:
            raise ValueError(
                f"{key}: {method!r}: a null predictor has no depth bias; write {name!r}"
            )
        if not is_classic(name):
            check_among(key, name, config.experiments)
        if isinstance(claim, LowerLossClaim):
            if config.experiments[method].training is None:
                raise ValueError(f"{key}: {method!r} is not trained, and has no loss")
            if (encoding := network_of(config, method).encoding) != "frequency":
                # Theirs is cross-entropy, or has some in it: no number to compare with depths'.
                raise ValueError(
                    f"{key}: {method!r} of encoding {encoding!r} has another loss than the thesis's "
                    "networks; compare it by image metrics (kind: better)"
                )
    if all(map(is_classic, names)):
        raise ValueError(f"{key}: {methods}: one of them should be an experiment")
    if len(set(methods)) < len(methods):
        raise ValueError(f"{key}: {methods[0]!r} is compared with itself")


def _check_printed(key: str, claim: PrintedClaim) -> None:
    printed = read_published(PUBLISHED_CSV).loc[claim.table].unstack()
    for row in claim.rows():
        check_among(f"{key}: rows of table {claim.table}", row, printed.index)
    for metric in claim.metrics:
        check_among(f"{key}.metrics of table {claim.table}", metric, printed.columns)


def _check_soft(config: "Config", key: str, claim: SoftBetterClaim | SoftEqualTimeClaim) -> None:
    # Times by radius, which rays are chosen by, are in the former alone.
    kinds = (
        ("soft_methods",) if claim.kind == "soft_equal_time" else ("soft_methods", "soft_summary")
    )
    tables = [name for name, table in config.tables.items() if table.kind in kinds]
    check_among(f"{key}.table", claim.table, tables)
    table = config.tables[claim.table]
    if isinstance(config.frame_sets[table.frame_set], OwnFrames):
        raise ValueError(f"{key}.table: {claim.table!r} is of frames of a user's own")
    given = methods_of(claim)
    for method in given:
        check_among(f"{key}: {claim.table}.methods", method, table.asked)
    radii = config.frame_sets[table.frame_set].radii
    for method in claim.again:
        networks = [name for name in given if name in config.screen_experiments]
        check_among(f"{key}.again", method, networks)
    for k in claim.radii or ():
        if k >= len(radii):
            raise ValueError(
                f"{key}.radii: {k} is not below {len(radii)}, the number of radii of "
                f"{table.frame_set!r}"
            )


def _check_seeds(config: "Config", key: str, claim: SoftClaim | RatioClaim) -> None:
    """Check that what a claim has again is the same but for seeds, of which each is another."""
    for network, others in other_seeds(config, claim):
        for other in others:
            if unlike := differences(config, network, other):
                raise ValueError(
                    f"{key}.{network}: {other!r} has another {unlike[0]} than {network!r}; should "
                    "differ from it in `seed` and `label` alone"
                )
        seeds = {}
        for name in (network, *others):
            seed = as_settings(config, name)["seed"]
            if seed in seeds:
                raise ValueError(
                    f"{key}.{network}: {name!r} has the seed {seed} of {seeds[seed]!r}; each should "
                    "have its own"
                )
            seeds[seed] = name

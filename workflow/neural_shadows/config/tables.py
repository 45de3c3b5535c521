"""`tables`: the tables of a run, by kind."""

from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import Field

from neural_shadows.config.base import Model, Name, by_kind, check_among, section_or
from neural_shadows.config.experiments import formatted
from neural_shadows.evaluation.costs import STAGES
from neural_shadows.evaluation.method_names import RAY_TRACED, biased_key, is_shadow_map

if TYPE_CHECKING:
    from neural_shadows.config.whole import Config


class RowSettings(Model):
    """A row of a table that is more than a name."""

    method: str = Field(description="an experiment, `shadow_map_N`, or `ray_traced` where timed")
    bias: Literal["held_out"] | None = Field(
        None, description="the depth bias that is best on held-out views, for the experiment's own"
    )
    label: str | None = Field(
        None, min_length=1, description="its name in the table; without it the experiment's label"
    )
    published: str | None = Field(
        None, description="the row's key in published.csv; without it the method's name"
    )


Rows = Annotated[list[section_or(RowSettings, "method")], Field(min_length=1)]


class AnyTable(Model):
    """What all tables have."""

    title: str = Field(min_length=1, description="heading of the table")
    published: str | None = Field(
        None, pattern=r"^4\.[1-7]$", description="the thesis's number of this table"
    )
    figures: list[Name] = Field(
        [], description="names in `figures` that are made and shown beside the table"
    )
    on_request: bool = Field(
        False, description="whether it is made only when asked for by name, and not by `all`"
    )


class TableOfOneScene(AnyTable):
    """A table of methods on one scene."""

    rows: Rows = Field(description="methods, in the table's order")
    scene: Name | None = Field(
        None, description="a name in `scenes`; without it that of the rows' experiments"
    )


class TableByScene(AnyTable):
    """A table of methods on several scenes."""

    rows: dict[Name, Rows] = Field(min_length=1, description="methods, by scene")


class ComparisonTable(TableOfOneScene):
    """A table of methods on the same viewpoints, beside the values that the thesis prints."""

    kind: Literal["comparison"] = Field("comparison", description="`comparison`, the default")


class MemoryTable(TableOfOneScene):
    """A table of the memory that methods take [4.4.2]."""

    kind: Literal["memory"] = Field(description="`memory`")


class FrameTimesTable(TableByScene):
    """A table of frame time, LPIPS and size [4.4.1]."""

    kind: Literal["frame_times"] = Field(description="`frame_times`")


class NetworksTable(TableByScene):
    """A table of networks beside shadow maps: quality, bytes, training, speed; by scene."""

    kind: Literal["networks"] = Field(description="`networks`")


class CostTable(AnyTable):
    """A table of what each stage costs while one size grows and the others stay."""

    kind: Literal["cost"] = Field(description="`cost`")
    subdivisions: list[Annotated[int, Field(ge=1, le=9)]] = Field(
        description="of a sphere's 20 triangles, each time into four: 6 gives 81,920"
    )
    samples: list[Annotated[int, Field(ge=10_000, le=10**9)]] = Field(
        description="rays of a ray set, 10,000 of each direction"
    )
    width: list[Annotated[int, Field(ge=1, le=4096)]] = Field(description="neurons per layer")
    views: list[Annotated[int, Field(ge=1, le=10_000)]] = Field(
        description="viewpoints of an evaluation"
    )
    frame_width: list[Annotated[int, Field(ge=48, le=8192)]] = Field(
        description="pixels; the height is two thirds of it"
    )


Table = by_kind(
    "kind",
    ComparisonTable,
    FrameTimesTable,
    NetworksTable,
    MemoryTable,
    CostTable,
    default="comparison",
)


def rows_by_scene(config: "Config", name: str) -> dict[str, list[RowSettings]]:
    """The rows of a table, by scene."""
    table = config.tables[name]
    if isinstance(table, CostTable):
        return {}
    if isinstance(table, TableByScene):
        return table.rows
    experiments = [config.experiments.get(row.method) for row in table.rows]
    scenes = {experiment.scene for experiment in experiments if experiment}
    return {table.scene or min(scenes, default=""): table.rows}


def method_key(config: "Config", row: RowSettings) -> str:
    """The key of a row's method: of a network whose own depth bias the row changes, another."""
    experiment = config.experiments.get(row.method)
    changed = experiment and row.bias is not None and row.bias != experiment.bias
    return biased_key(row.method) if changed else row.method


def row_label(config: "Config", row: RowSettings) -> str:
    """What a row is called, in its own words or made from its method."""
    if row.method in config.experiments:
        label = formatted(config, row.method, row.label)
        changed = method_key(config, row) != row.method and row.label is None
        return f"{label}, with bias" if changed else label
    if row.method == RAY_TRACED:
        return row.label or "Ray traced"
    return row.label or f"{row.method.removeprefix('shadow_map_')}² shadow map"


def check(config: "Config") -> None:
    """Check names in tables, and that each row of a scene has a method and label of its own."""
    for name, table in config.tables.items():
        key = f"tables.{name}"
        if name in ("claims", "index"):
            raise ValueError(f"{key}: a report has this name; choose another")
        for figure in table.figures:
            check_among(f"{key}.figures", figure, config.figures)
        if isinstance(table, CostTable):
            for size in STAGES:
                if (values := getattr(table, size)) != sorted(set(values)):
                    raise ValueError(f"{key}.{size} = {values}: must grow from each to the next")
        timed = [RAY_TRACED] if isinstance(table, TableByScene) else []
        for scene, rows in rows_by_scene(config, name).items():
            check_among(f"{key}.scene", scene, config.scenes)
            here = [name for name, other in config.experiments.items() if other.scene == scene]
            for row in rows:
                if not is_shadow_map(row.method):
                    allowed = ["shadow_map_N", *timed, *here]
                    check_among(f"{key}.rows of {scene}", row.method, allowed)
                if row.bias is not None:
                    check_among(f"{key}.rows with a bias", row.method, here)
            _check_once(f"{key}.rows of {scene}", [method_key(config, row) for row in rows])
            _check_once(f"{key}.rows of {scene}", [row_label(config, row) for row in rows])


def _check_once(key: str, values: list[str]) -> None:
    for value in values:
        if values.count(value) > 1:
            raise ValueError(f"{key}: {value!r} is there twice; should be there once")

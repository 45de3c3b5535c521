"""`tables`: the tables of a run, by kind."""

from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag

from neural_shadows.config.base import ON_REQUEST, Model, Name


class Row(Model):
    """A row of a table."""

    method: str = Field(
        description="`shadow_map_N`, or the name of an experiment of the table's evaluations"
    )
    label: str = Field(min_length=1, description="the row's name in the table")
    published: str | None = Field(
        None, description="the row's key in published.csv; without it the method's name"
    )


class TimedRow(Row):
    """A row of a table of frame times."""

    method: str = Field(
        description="an experiment of the table's evaluations, `shadow_map_N` or `ray_traced`"
    )
    scene: Name | None = Field(
        None, description="a name in `scenes`; needed for `shadow_map_N` and `ray_traced` alone"
    )


class AnyTable(Model):
    """What all tables have."""

    title: str = Field(min_length=1, description="heading of the table")
    published: str | None = Field(
        None,
        pattern=r"^4\.[1-7]$",
        description="the thesis's number of this table; null for a table of your own",
    )


class Table(AnyTable):
    """A table of methods on the same viewpoints, beside the values that the thesis prints."""

    kind: Literal["comparison"] = Field("comparison", description="`comparison`, the default")
    evaluations: list[Name] = Field(
        min_length=1,
        description="names in `evaluations`, of one scene and the same view sets; rows are theirs",
    )
    rows: list[Row] = Field(min_length=1, description="methods, in the table's order")
    figures: list[Name] = Field(
        [], description="names in `figures` that are made and shown beside the table"
    )


class FrameTimesTable(AnyTable):
    """A table of frame time, LPIPS and size [4.4.1]."""

    kind: Literal["frame_times"] = Field(description="`frame_times`")
    evaluations: list[Name] = Field(
        min_length=1, description="names in `evaluations` that give the networks' LPIPS"
    )
    rows: list[TimedRow] = Field(min_length=1, description="methods, in the table's order")


class NetworksTable(AnyTable):
    """A table of networks beside shadow maps: quality, bytes, training, speed; by scene."""

    kind: Literal["networks"] = Field(description="`networks`")
    evaluations: list[Name] = Field(
        min_length=1, description="names in `evaluations`; rows are methods of theirs"
    )
    rows: list[TimedRow] = Field(min_length=1, description="methods, in the table's order")
    on_request: bool = ON_REQUEST


class MemoryTable(AnyTable):
    """A table of the memory that methods take [4.4.2]."""

    kind: Literal["memory"] = Field(description="`memory`")
    rows: list[Row] = Field(min_length=1, description="experiments and `shadow_map_N`")


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
    on_request: bool = ON_REQUEST


def _table_kind(value: Any) -> str | None:
    kind = value.get("kind", "comparison") if isinstance(value, dict) else "comparison"
    return kind if kind in ("comparison", "frame_times", "networks", "memory", "cost") else None


AnyTableKind = Annotated[
    Annotated[Table, Tag("comparison")]
    | Annotated[FrameTimesTable, Tag("frame_times")]
    | Annotated[NetworksTable, Tag("networks")]
    | Annotated[MemoryTable, Tag("memory")]
    | Annotated[CostTable, Tag("cost")],
    Discriminator(
        _table_kind,
        custom_error_type="table_kind",
        custom_error_message="`kind` should be comparison (the default), frame_times, networks, memory or cost",
    ),
]

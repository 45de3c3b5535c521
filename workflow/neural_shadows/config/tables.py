"""`tables`: the tables of a run, by kind."""

from collections import Counter
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import Field

from neural_shadows.config.any_table import AnyTable
from neural_shadows.config.base import Model, Text, by_kind, check_among, name_in, section_or
from neural_shadows.config.experiments import formatted, network_of, training_of
from neural_shadows.config.screen_tables import (
    ScreenErrorsTable,
    ScreenNetworksTable,
    ScreenProfileTable,
    ScreenStepsTable,
    ScreenTemporalTable,
    ScreenTrainedTable,
)
from neural_shadows.config.soft_tables import (
    PenumbraTable,
    SoftMethodsTable,
    SoftSummaryTable,
    check_soft,
)
from neural_shadows.evaluation.costs import STAGES
from neural_shadows.evaluation.method_names import (
    CLASSIC,
    NO_SHADOW,
    NULL,
    RAY_TRACED,
    biased_key,
    classic_label,
    is_classic,
    is_null,
)

if TYPE_CHECKING:
    from neural_shadows.config.whole import Config


class RowSettings(Model):
    """A row of a table that is more than a name."""

    method: str = Field(
        description="an experiment, a map (`shadow_map_N`), `no_shadow`, or `ray_traced` if timed"
    )
    bias: Literal["held_out"] | None = Field(
        None, description="the depth bias that is best on held-out views, for the method's own"
    )
    label: Text | None = Field(None, description="without it the method's own label")
    published: str | None = Field(None, description="its key in published.csv, if not `method`")


Rows = Annotated[list[section_or(RowSettings, "method")], Field(min_length=1)]


class TableOfOneScene(AnyTable):
    """A table of methods on one scene: their quality, or the memory that they take [4.4.2]."""

    rows: Rows = Field(description="methods, in the table's order")
    scene: name_in("scenes") | None = Field(
        None, description="a name in `scenes`; without it that of the rows' experiments"
    )
    kind: Literal["comparison", "memory"] = Field(
        "comparison", description="`comparison`, the default, on the same viewpoints; or `memory`"
    )
    against: str | None = Field(
        None, description="the row whose paired differences to all others are given"
    )


class TableByScene(AnyTable):
    """A table of methods on several scenes."""

    rows: dict[name_in("scenes"), Rows] = Field(min_length=1, description="methods, by scene")
    kind: Literal["frame_times", "networks", "learning_curves"] = Field(
        description="speed [4.4.1], everything, or what each budget of `learning_curves` reaches"
    )
    against: dict[name_in("scenes"), str] = Field(
        {}, description="the row whose paired differences to all others are given, by scene"
    )


class CostTable(AnyTable):
    """A table of what each stage costs while one size grows and the others stay."""

    kind: Literal["cost"] = Field(description="`cost`")
    subdivisions: list[Annotated[int, Field(ge=1, le=9)]] = Field(
        description="of 20 triangles into 4 each"
    )
    samples: list[Annotated[int, Field(ge=10_000, le=10**9)]] = Field(
        description="10,000 of a direction"
    )
    width: list[Annotated[int, Field(ge=1, le=4096)]] = Field(description="neurons per layer")
    views: list[Annotated[int, Field(ge=1, le=10_000)]] = Field(description="of an evaluation")
    frame_width: list[Annotated[int, Field(ge=48, le=8192)]] = Field(description="pixels of 3:2")


Table = by_kind(
    "kind",
    TableOfOneScene,
    TableByScene,
    CostTable,
    SoftMethodsTable,
    SoftSummaryTable,
    PenumbraTable,
    ScreenProfileTable,
    ScreenNetworksTable,
    ScreenTrainedTable,
    ScreenErrorsTable,
    ScreenStepsTable,
    ScreenTemporalTable,
    default="comparison",
)

# What stands in each table of a kind beside its methods: a network that is not better than no
# shadow at all has learned nothing that such a table could show.
NULL_ROWS = {"comparison": tuple(NULL), "networks": tuple(NULL), "frame_times": (NO_SHADOW,)}

# The kinds that give paired differences to the row `against`.
WITH_DIFFERENCES = ("comparison", "networks")

Row = dict[str, Any]  # method, label, published, scene, experiment, encoding, trained, bias


def settings_by_scene(config: "Config", table: AnyTable) -> dict[str, list[RowSettings]]:
    """The rows of a table by scene, null predictors among them; none of a table of costs, of soft
    shadows, or of networks of whole frames.
    """
    if not hasattr(table, "rows"):
        return {}
    rows = table.rows
    if isinstance(table, TableOfOneScene):
        experiments = [config.experiments.get(row.method) for row in rows]
        scenes = {experiment.scene for experiment in experiments if experiment}
        rows = {table.scene or min(scenes, default=""): rows}
    return {scene: [*given, *_null_rows(table, given)] for scene, given in rows.items()}


def _null_rows(table: AnyTable, given: list[RowSettings]) -> list[RowSettings]:
    named = {row.method for row in given}
    missing = [method for method in NULL_ROWS.get(table.kind, ()) if method not in named]
    return [RowSettings(method=method) for method in missing]


def rows_of(config: "Config", name: str) -> list[Row]:
    """The rows of a table, as `settings_by_scene` has them.

    Returns: of each row `method`, the method's key; `label`; `published`, its key in
        published.csv or None if the table is not the thesis's; `scene`; `experiment` and the
        network's `encoding`, or None if it is none, and whether it is `trained`; `bias`, a number,
        `held_out`, or None if it has none.
    """
    table = config.tables[name]
    return [
        row_of(config, scene, row)
        | {"published": (row.published or row.method) if table.published else None}
        for scene, rows in settings_by_scene(config, table).items()
        for row in rows
    ]


def row_of(config: "Config", scene: str, row: RowSettings) -> Row:
    """A row of `rows_of` that is not the thesis's."""
    method, own, label = row.method, None, row.label
    if experiment := config.experiments.get(row.method):
        label, own = formatted(config, row.method, row.label), experiment.bias
    elif method == RAY_TRACED:
        label = label or "Ray traced"
    else:
        label = label or classic_label(method)
    bias = row.bias or own
    if bias != own:  # of a method whose own depth bias the row changes
        method = biased_key(method)
        label = label if row.label else f"{label}, with bias"
    return {
        "method": method,
        "label": label,
        "published": None,
        "scene": scene,
        "experiment": row.method if experiment else None,
        "encoding": network_of(config, row.method).encoding if experiment else None,
        "trained": bool(experiment and training_of(config, row.method)),
        "bias": bias,
    }


def check(config: "Config") -> None:
    """Check that each row of a scene is a method there, with a key and a label of its own."""
    for name, table in config.tables.items():
        key = f"tables.{name}"
        if name in ("claims", "index"):
            raise ValueError(f"{key}: a report has this name; choose another")
        if isinstance(table, CostTable):
            for size in STAGES:
                if (values := getattr(table, size)) != sorted(set(values)):
                    raise ValueError(f"{key}.{size} = {values}: must grow from each to the next")
        if isinstance(table, SoftMethodsTable | SoftSummaryTable | ScreenTemporalTable):
            check_soft(config, key, table)
        if table.kind == "learning_curves" and config.learning_curves is None:
            raise ValueError(f"{key}.kind: {table.kind!r} needs the section `learning_curves`")
        for scene, rows in settings_by_scene(config, table).items():
            if not scene:
                raise ValueError(f"{key}: has shadow maps alone and needs a `scene`")
            for row in rows:
                _check_method(config, f"{key}.rows of {scene}", table, scene, row)
            made = [row_of(config, scene, row) for row in rows]
            for part in ("method", "label"):
                for value, count in Counter(row[part] for row in made).items():
                    if count > 1:
                        raise ValueError(
                            f"{key}.rows of {scene}: {value!r} is there twice; should be there once"
                        )
            against = getattr(table, "against", None)
            if against and table.kind not in WITH_DIFFERENCES:
                raise ValueError(
                    f"{key}.against: a table of kind {table.kind!r} gives no differences; leave it "
                    f"out (kinds that do: {', '.join(WITH_DIFFERENCES)})"
                )
            against = against.get(scene) if isinstance(against, dict) else against
            if against is not None:
                check_among(f"{key}.against", against, [row["method"] for row in made])


def _check_method(
    config: "Config", key: str, table: AnyTable, scene: str, row: RowSettings
) -> None:
    if row.bias is not None and is_null(row.method):
        raise ValueError(
            f"{key}: {row.method!r} with a bias: a null predictor has no depth bias; leave it out"
        )
    curves = table.kind == "learning_curves"
    names = config.learning_curves.experiments if curves else config.experiments
    allowed = [name for name in names if config.experiments[name].scene == scene]
    if not curves:
        if is_classic(row.method):
            return
        timed = [RAY_TRACED] * (isinstance(table, TableByScene) and row.bias is None)
        allowed = [*(f"{family}_N" for family in CLASSIC), *NULL, *timed, *allowed]
    check_among(key, row.method, allowed)

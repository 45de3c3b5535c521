"""`figures`: the figures of a run, by kind."""

from typing import TYPE_CHECKING, Literal

from pydantic import Field

from neural_shadows.config.base import Model, Name, by_kind, check_known, instead, section_or
from neural_shadows.config.experiments import formatted, network_of
from neural_shadows.config.scenes import ViewSet
from neural_shadows.config.tables import TableByScene, method_key, rows_by_scene
from neural_shadows.evaluation.method_names import RAY_TRACED

if TYPE_CHECKING:
    from neural_shadows.config.whole import Config


class AnyFigure(Model):
    """What all figures have."""

    title: str = Field(min_length=1, description="heading of the figure")


class PicturesFigure(AnyFigure):
    """The same viewpoints by every method, whole and as crops [figures 4.4 to 4.7]."""

    kind: Literal["pictures"] = Field(description="`pictures`")
    table: str = Field(
        description="a table of `comparison` or `networks` in `tables`; its rows are drawn"
    )
    scene: Name | None = Field(
        None, description="which scene of a table of `networks`; needed there alone"
    )
    methods: list[str] | None = Field(
        None,
        min_length=1,
        description=(
            "which of the table's methods; without it all are drawn; a row with a `bias` of its "
            "own is called NAME_biased"
        ),
    )
    view_sets: list[ViewSet] = Field(
        min_length=1, description="view sets of the scene; the first view of each"
    )


class CurveSettings(Model):
    """A curve of a figure of training losses that is more than a name."""

    experiment: Name = Field(description="a name in `experiments`")
    label: str | None = Field(
        None, min_length=1, description="its name in the figure; without it the experiment's label"
    )


class LossFigure(AnyFigure):
    """Training loss over steps [figures 4.1 to 4.3]."""

    kind: Literal["loss"] = Field(description="`loss`")
    curves: list[section_or(CurveSettings, "experiment")] = Field(
        min_length=1, description="experiments, in the legend's order"
    )


class WidthsFigure(AnyFigure):
    """LPIPS and frame time over layer width [figure 4.8]."""

    kind: Literal["widths"] = Field(description="`widths`")
    table: str = Field(description="a table of `frame_times` in `tables`")


class MethodFigure(AnyFigure):
    """A picture of how the method works, from real data [figures 3.1 to 3.6]."""

    kind: Literal[
        "overview",
        "shadow_boundary",
        "view_directions",
        "quadtree",
        "dual_bounds",
        "dead_zone_loss",
    ] = Field(description="what is drawn")
    scene: Name = Field(description="a name in `scenes`")
    sampling: Name = Field(description="a name in `samplings`")


class ParetoFigure(AnyFigure):
    """LPIPS over bytes, frame time and training time, with the best of each trade-off joined."""

    kind: Literal["pareto"] = Field(description="`pareto`")
    table: str = Field(description="a table of `networks` in `tables`")
    scene: Name = Field(description="a scene of that table")


class CostFigure(AnyFigure):
    """Time and memory of each stage over each size."""

    kind: Literal["cost"] = Field(description="`cost`")
    table: str = Field(description="a table of `cost` in `tables`")


class FieldSliceFigure(AnyFigure):
    """A slice through an occupancy field's logits, beside the mesh that it learned."""

    kind: Literal["field_slice"] = Field(description="`field_slice`")
    experiment: Name = Field(description="an experiment whose network is an `occupancy_field`")


Figure = by_kind(
    "kind",
    PicturesFigure,
    LossFigure,
    WidthsFigure,
    ParetoFigure,
    CostFigure,
    FieldSliceFigure,
    MethodFigure,
)
KINDS_OF_TABLE = {
    "pictures": ("comparison", "networks"),
    "widths": ("frame_times",),
    "pareto": ("networks",),
    "cost": ("cost",),
}


def check(config: "Config") -> None:
    """Check names in figures, and that each is of a table or network that it can show."""
    for name, figure in config.figures.items():
        key = f"figures.{name}"
        for part in ("table", "scene", "sampling", "experiment"):
            if (value := getattr(figure, part, None)) is not None:
                check_known(f"{key}.{part}", value, f"{part}s", getattr(config, f"{part}s"))
        if table := getattr(figure, "table", None):
            kind, allowed = config.tables[table].kind, KINDS_OF_TABLE[figure.kind]
            if kind not in allowed:
                raise ValueError(
                    f"{key}.table: {table!r} is a table of {kind}; "
                    f"allowed: one of {' or '.join(allowed)}"
                )
        match figure:
            case LossFigure():
                for curve in figure.curves:
                    check_known(
                        f"{key}.curves", curve.experiment, "experiments", config.experiments
                    )
                    formatted(config, curve.experiment, curve.label)
            case FieldSliceFigure():
                encoding = network_of(config, figure.experiment).encoding
                if encoding != "occupancy_field":
                    raise ValueError(
                        f"{key}.experiment: {figure.experiment!r} is a network of {encoding}; "
                        "allowed: one of occupancy_field"
                    )
            case ParetoFigure() | PicturesFigure():
                _check_scene(config, key, figure)
                if isinstance(figure, PicturesFigure):
                    _check_pictures(config, key, figure)


def figure_scene(config: "Config", figure: PicturesFigure | ParetoFigure) -> str:
    """The scene of a figure of a table: the one that it names, or the table's only one."""
    return figure.scene or next(iter(rows_by_scene(config, figure.table)))


def _check_scene(config: "Config", key: str, figure: PicturesFigure | ParetoFigure) -> None:
    scenes = rows_by_scene(config, figure.table)
    if isinstance(config.tables[figure.table], TableByScene):
        if figure.scene not in scenes:
            raise ValueError(
                f"{key}.scene: {figure.scene!r} is not in {figure.table}; "
                f"allowed: {', '.join(scenes)}"
            )
    elif figure.scene is not None:
        raise ValueError(f"{key}.scene: {figure.table!r} has one scene; leave `scene` out")


def _check_pictures(config: "Config", key: str, figure: PicturesFigure) -> None:
    scene = figure_scene(config, figure)
    rows = rows_by_scene(config, figure.table)[scene]
    drawn = [method_key(config, row) for row in rows if row.method != RAY_TRACED]
    for method in figure.methods or []:
        if method not in drawn:
            raise ValueError(
                f"{key}.methods: has no pictures in {figure.table}: {instead(method, drawn)}"
            )
    rendered = config.scenes[scene].view_sets
    for view_set in figure.view_sets:
        if view_set not in rendered:
            raise ValueError(
                f"{key}.view_sets: {view_set!r} is not rendered for {figure.table}; "
                f"allowed: {', '.join(rendered)}"
            )

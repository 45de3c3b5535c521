"""`figures`: the figures of a run, by kind."""

from typing import TYPE_CHECKING, Literal

from pydantic import Field

from neural_shadows.config.base import Model, Name, by_kind, check_among, section_or
from neural_shadows.config.experiments import formatted, network_of
from neural_shadows.config.scenes import ViewSet
from neural_shadows.config.tables import method_key, rows_by_scene
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


def figure_scene(config: "Config", figure: PicturesFigure | ParetoFigure) -> str:
    """The scene of a figure of a table: the one that it names, or the table's only one."""
    return figure.scene or next(iter(rows_by_scene(config, figure.table)))


def check(config: "Config") -> None:
    """Check names in figures, and that each is of a table or network that it can show."""
    for name, figure in config.figures.items():
        key = f"figures.{name}"
        if hasattr(figure, "table"):
            kinds = KINDS_OF_TABLE[figure.kind]
            tables = [name for name, table in config.tables.items() if table.kind in kinds]
            check_among(f"{key}.table", figure.table, tables)
        match figure:
            case MethodFigure():
                check_among(f"{key}.scene", figure.scene, config.scenes)
                check_among(f"{key}.sampling", figure.sampling, config.samplings)
            case LossFigure():
                for curve in figure.curves:
                    check_among(f"{key}.curves", curve.experiment, config.experiments)
                    formatted(config, curve.experiment, curve.label)
            case FieldSliceFigure():
                fields = [
                    name
                    for name in config.experiments
                    if network_of(config, name).encoding == "occupancy_field"
                ]
                check_among(f"{key}.experiment", figure.experiment, fields)
            case ParetoFigure() | PicturesFigure():
                scenes = rows_by_scene(config, figure.table)
                if figure.scene is not None or len(scenes) > 1:
                    check_among(f"{key}.scene", figure.scene or "", scenes)
                if isinstance(figure, PicturesFigure):
                    scene = figure_scene(config, figure)
                    drawn = [
                        method_key(config, row) for row in scenes[scene] if row.method != RAY_TRACED
                    ]
                    for method in figure.methods or []:
                        check_among(f"{key}.methods", method, drawn)
                    for view_set in figure.view_sets:
                        check_among(f"{key}.view_sets", view_set, config.scenes[scene].view_sets)

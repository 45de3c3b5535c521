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


class MethodsFigure(AnyFigure):
    """Methods of a table side by side."""

    table: Name = Field(
        description="a table of `comparison` or `networks` in `tables`; its rows are drawn"
    )
    scene: Name | None = Field(None, description="which scene of a table of several")
    methods: list[str] | None = Field(
        None,
        min_length=1,
        description="which of its methods; a row with a `bias` of its own is called NAME_biased",
    )


class PicturesFigure(MethodsFigure):
    """The same viewpoints by every method, whole and as crops [figures 4.4 to 4.7]."""

    kind: Literal["pictures"] = Field(description="`pictures`")
    view_sets: list[ViewSet] = Field(
        min_length=1, description="view sets of the scene; the first view of each"
    )


class ErrorsFigure(MethodsFigure):
    """False shadow and light leak where they are on the mesh, in three dimensions."""

    kind: Literal["errors_3d"] = Field(description="`errors_3d`")


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
    table: Name = Field(description="a table of `frame_times` in `tables`")


class DirectionsFigure(AnyFigure):
    """View directions by sampler, and their spectra [figure 3.3]."""

    kind: Literal["view_directions"] = Field(description="`view_directions`")


class SceneFigure(AnyFigure):
    """A slice of a scene with rays, their bounds or their loss [figures 3.2, 3.5, 3.6]."""

    kind: Literal["shadow_boundary", "dual_bounds", "dead_zone_loss"] = Field(
        description="what is drawn"
    )
    scene: Name = Field(description="a name in `scenes`")


class SamplingFigure(AnyFigure):
    """How a scene's rays are drawn [figures 3.1, 3.4], and all of it in three dimensions."""

    kind: Literal["overview", "quadtree", "scene_3d"] = Field(description="what is drawn")
    scene: Name = Field(description="a name in `scenes`")
    sampling: Name = Field(description="a name in `samplings`")


class ParetoFigure(AnyFigure):
    """LPIPS over bytes, frame time and training time, with the best of each trade-off joined."""

    kind: Literal["pareto"] = Field(description="`pareto`")
    table: Name = Field(description="a table of `networks` in `tables`")
    scene: Name = Field(description="a scene of that table")


class CostFigure(AnyFigure):
    """Time and memory of each stage over each size."""

    kind: Literal["cost"] = Field(description="`cost`")
    table: Name = Field(description="a table of `cost` in `tables`")


class FieldFigure(AnyFigure):
    """What an occupancy field holds: a slice of its logits, or its surface."""

    kind: Literal["field_slice", "field_3d"] = Field(description="`field_slice` or `field_3d`")
    experiment: Name = Field(description="an experiment whose network is an `occupancy_field`")


class DepthsFigure(AnyFigure):
    """A network's depth for one light between its bounds, as sheets in three dimensions."""

    kind: Literal["depth_sheets_3d"] = Field(description="`depth_sheets_3d`")
    experiment: Name = Field(description="a name in `experiments`")


Figure = by_kind(
    "kind",
    PicturesFigure,
    LossFigure,
    WidthsFigure,
    ParetoFigure,
    CostFigure,
    FieldFigure,
    DepthsFigure,
    ErrorsFigure,
    DirectionsFigure,
    SceneFigure,
    SamplingFigure,
)
KINDS_OF_TABLE = {
    "pictures": ("comparison", "networks"),
    "errors_3d": ("comparison", "networks"),
    "widths": ("frame_times",),
    "pareto": ("networks",),
    "cost": ("cost",),
}


def figure_scene(config: "Config", figure: MethodsFigure | ParetoFigure) -> str:
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
            case SceneFigure():
                check_among(f"{key}.scene", figure.scene, config.scenes)
            case SamplingFigure():
                check_among(f"{key}.scene", figure.scene, config.scenes)
                check_among(f"{key}.sampling", figure.sampling, config.samplings)
            case LossFigure():
                for curve in figure.curves:
                    check_among(f"{key}.curves", curve.experiment, config.experiments)
                    formatted(config, curve.experiment, curve.label)
            case FieldFigure():
                fields = [
                    name
                    for name in config.experiments
                    if network_of(config, name).encoding == "occupancy_field"
                ]
                check_among(f"{key}.experiment", figure.experiment, fields)
            case DepthsFigure():
                check_among(f"{key}.experiment", figure.experiment, config.experiments)
            case ParetoFigure() | MethodsFigure():
                scenes = rows_by_scene(config, figure.table)
                if figure.scene is not None or len(scenes) > 1:
                    check_among(f"{key}.scene", figure.scene or "", scenes)
                if isinstance(figure, MethodsFigure):
                    _check_methods(config, key, figure)


def _check_methods(config: "Config", key: str, figure: MethodsFigure) -> None:
    scene = figure_scene(config, figure)
    rows = rows_by_scene(config, figure.table)[scene]
    drawn = [method_key(config, row) for row in rows if row.method != RAY_TRACED]
    for method in figure.methods or []:
        check_among(f"{key}.methods", method, drawn)
    for view_set in getattr(figure, "view_sets", []):
        check_among(f"{key}.view_sets", view_set, config.scenes[scene].view_sets)

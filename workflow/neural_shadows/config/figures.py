"""`figures`: the figures of a run, by kind."""

from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import Field

from neural_shadows.config.base import (
    Model,
    Name,
    Text,
    by_kind,
    check_among,
    name_in,
    section_or,
)
from neural_shadows.config.experiments import formatted, network_of
from neural_shadows.config.frame_sets import measured_scenes
from neural_shadows.config.own_frames import OwnFrames
from neural_shadows.config.scenes import ViewSet
from neural_shadows.config.tables import Row, rows_of
from neural_shadows.evaluation.method_names import RAY_TRACED, is_null
from neural_shadows.frames.light_size import shown_radii

if TYPE_CHECKING:
    from neural_shadows.config.whole import Config


class AnyFigure(Model):
    """What all figures have."""

    title: str = Field(min_length=1, description="heading of the figure")


class MethodsFigure(AnyFigure):
    """Methods of a table side by side: their errors on the mesh, or all views of each, small."""

    table: Name = Field(description="a table of `comparison` or `networks`")
    scene: Name | None = Field(None, description="which scene of a table of several")
    methods: list[str] | None = Field(
        None, min_length=1, description="which of its rows; NAME_biased with a bias of its own"
    )
    kind: Literal["errors_3d", "contact_sheet"] = Field(description="what is drawn")


class PicturesFigure(MethodsFigure):
    """The same viewpoints by every method, whole and as crops [figures 4.4 to 4.7]."""

    kind: Literal["pictures"] = Field(description="`pictures`")
    view_sets: list[ViewSet] = Field(min_length=1, description="a view of each is shown")


class CurveSettings(Model):
    """A curve of a figure of training losses that is more than a name."""

    experiment: name_in("experiments") = Field(description="a name in `experiments`")
    label: Text | None = Field(None, description="without it the experiment's label")


class LossFigure(AnyFigure):
    """Training loss over steps [figures 4.1 to 4.3]."""

    kind: Literal["loss"] = Field(description="`loss`")
    curves: list[section_or(CurveSettings, "experiment")] = Field(
        min_length=1, description="experiments, in the legend's order"
    )


class TableFigure(AnyFigure):
    """A table drawn: quality and times over layer width [figure 4.8], or costs over sizes."""

    kind: Literal["widths", "cost"] = Field(description="what is drawn")
    table: Name = Field(description="a table of `frame_times` in `tables`, or of `cost`")


class DirectionsFigure(AnyFigure):
    """View directions by sampler, and their spectra [figure 3.3]."""

    kind: Literal["view_directions"] = Field(description="`view_directions`")


class SceneFigure(AnyFigure):
    """A slice of a scene with rays, their bounds or their loss [figures 3.2, 3.5, 3.6]."""

    kind: Literal["shadow_boundary", "dual_bounds", "dead_zone_loss"] = Field(description="of what")
    scene: name_in("scenes") = Field(description="a name in `scenes`")


class SamplingFigure(SceneFigure):
    """How a scene's rays are drawn [figures 3.1, 3.4], and all of it in three dimensions."""

    kind: Literal["overview", "quadtree", "scene_3d"] = Field(description="what is drawn")
    sampling: name_in("samplings") = Field(description="a name in `samplings`")


class ParetoFigure(AnyFigure):
    """Quality over bytes, own time and building, with the best of each trade-off joined."""

    kind: Literal["pareto"] = Field(description="`pareto`")
    table: Name = Field(description="a table of `networks` in `tables`")
    scene: Name = Field(description="a scene of that table")
    costs: list[Literal["stored_bytes", "resident_bytes", "own_ms", "build_seconds"]] = Field(
        ["stored_bytes", "resident_bytes", "own_ms", "build_seconds"],
        min_length=1,
        description="what quality is drawn over; the first figure of `stored_bytes` alone opens "
        "the page",
    )


class LearningCurvesFigure(AnyFigure):
    """Loss and quality over training samples, with what the smaller budgets predict."""

    kind: Literal["learning_curves"] = Field(description="`learning_curves`")
    table: Name = Field(description="a table of `learning_curves` in `tables`")
    scene: Name | None = Field(None, description="which scene of a table of several")


class SoftTableFigure(AnyFigure):
    """Error over milliseconds of the methods of a table of soft shadows."""

    kind: Literal["soft_equal_time"] = Field(description="`soft_equal_time`")
    table: Name = Field(description="a table of `soft_methods` in `tables`")
    radii: list[int] | None = Field(
        None, min_length=1, description="which radii, counted from 0; by default all but a point"
    )


class SoftPicturesFigure(AnyFigure):
    """A frame by methods of a table of soft shadows, with their errors, at several radii.

    The page lets any two of them be compared.
    """

    kind: Literal["soft_pictures"] = Field(description="`soft_pictures`")
    table: Name = Field(description="a table of `soft_methods` in `tables`")
    soft_scene: name_in("soft_scenes") = Field(description="whose first test frame is shown")
    methods: list[str] = Field(min_length=1, description="which of the table's methods")
    radii: list[int] | None = Field(
        None,
        min_length=1,
        description="which radii, counted from 0; by default the least but a point, the middle "
        "and the largest",
    )


class SoftRadiiFigure(AnyFigure):
    """Error over the light's radius, of methods for soft shadows."""

    kind: Literal["soft_radii"] = Field(description="`soft_radii`")
    table: Name = Field(description="a table of `soft_summary` in `tables`, `by: radius`")


class ScreenTableFigure(AnyFigure):
    """Of a network of whole frames the time by level and part, or the worth of its features."""

    kind: Literal["screen_level_time", "screen_sensitivity"] = Field(
        description="of a table of `screen_parts`, or of `screen_features`"
    )
    table: Name = Field(description="a name in `tables`")


class ScreenFlickerFigure(AnyFigure):
    """Where methods of a table of `screen_temporal` flicker in its frame set's sequences."""

    kind: Literal["screen_flicker"] = Field(description="`screen_flicker`")
    table: Name = Field(description="a table of `screen_temporal` in `tables`")
    methods: list[str] = Field(min_length=1, description="which of the table's methods")


class PenumbraFigure(AnyFigure):
    """The widths of penumbrae by Neural Shadow Mapping's model, beside what they measure."""

    kind: Literal["penumbra_model"] = Field(description="`penumbra_model`")
    frame_set: name_in("frame_sets") = Field(description="a name in `frame_sets`")


class NetworkFigure(AnyFigure):
    """What a network holds: a slice or the surface of a field, or any one's depths for a light."""

    kind: Literal["field_slice", "field_3d", "depth_sheets_3d"] = Field(description="what is drawn")
    experiment: name_in("experiments") = Field(
        description="of an `occupancy_field`, if a field is drawn"
    )


class ForestFigure(AnyFigure):
    """Many copies of few objects, in the shadows of their fields and of their triangles."""

    kind: Literal["forest"] = Field(description="`forest`")
    scenes: list[name_in("scenes")] = Field(
        min_length=1, description="names in `scenes`, whose meshes are closed"
    )
    instances: int = Field(1000, ge=1, le=100_000, description="copies, as many of each")
    resolution: Annotated[int, Field(ge=16, le=1024, multiple_of=4)] = Field(
        256, description="cells of each object's field along an axis, a multiple of 4"
    )


Figure = by_kind(
    "kind",
    PicturesFigure,
    LossFigure,
    TableFigure,
    ParetoFigure,
    LearningCurvesFigure,
    NetworkFigure,
    MethodsFigure,
    DirectionsFigure,
    SceneFigure,
    SamplingFigure,
    SoftTableFigure,
    SoftPicturesFigure,
    SoftRadiiFigure,
    PenumbraFigure,
    ScreenTableFigure,
    ScreenFlickerFigure,
    ForestFigure,
)
KINDS_OF_TABLE = {
    "pictures": ("comparison", "networks"),
    "errors_3d": ("comparison", "networks"),
    "contact_sheet": ("comparison", "networks"),
    "widths": ("frame_times",),
    "pareto": ("networks",),
    "learning_curves": ("learning_curves",),
    "cost": ("cost",),
    "soft_equal_time": ("soft_methods",),
    "soft_pictures": ("soft_methods", "soft_summary"),
    "soft_radii": ("soft_summary",),
    "screen_level_time": ("screen_parts",),
    "screen_sensitivity": ("screen_features",),
    "screen_flicker": ("screen_temporal",),
}


def scene_of(
    config: "Config", figure: "MethodsFigure | ParetoFigure | LearningCurvesFigure"
) -> str:
    """The scene of a figure of a table: the one that it names, or the table's first."""
    return figure.scene or rows_of(config, figure.table)[0]["scene"]


def rows_of_figure(config: "Config", figure: AnyFigure) -> list[Row]:
    """The rows of a figure of a table: those of its scene, or of `widths` those with a `width`."""
    rows = rows_of(config, figure.table)
    if isinstance(figure, TableFigure):
        networks = [row for row in rows if row["experiment"]]
        widths = [getattr(network_of(config, row["experiment"]), "width", None) for row in networks]
        return [row | {"width": width} for row, width in zip(networks, widths) if width]
    rows = [row for row in rows if row["scene"] == scene_of(config, figure)]
    if isinstance(figure, MethodsFigure):
        # Ray tracing's pictures are the reference, which is shown anyway; those of no shadow and
        # of nothing else need no picture.
        drawn = [row for row in rows if row["method"] != RAY_TRACED and not is_null(row["method"])]
        rows = [row for row in drawn if not figure.methods or row["method"] in figure.methods]
    return rows


def radii_of(config: "Config", figure: SoftPicturesFigure) -> list[int]:
    """The radii of a figure's frame set that it shows, counted from 0."""
    count = len(config.frame_sets[config.tables[figure.table].frame_set].radii)
    return figure.radii or shown_radii(count)


def check(config: "Config") -> None:
    """Check that each figure is of a table or network that it can show."""
    for name, figure in config.figures.items():
        key = f"figures.{name}"
        if hasattr(figure, "table"):
            kinds = KINDS_OF_TABLE[figure.kind]
            tables = [name for name, table in config.tables.items() if table.kind in kinds]
            check_among(f"{key}.table", figure.table, tables)
        match figure:
            case LossFigure():
                for curve in figure.curves:
                    formatted(config, curve.experiment, curve.label)
                    if config.experiments[curve.experiment].training is None:
                        raise ValueError(
                            f"{key}.curves: {curve.experiment!r} is built without training and has "
                            "no loss; leave it out"
                        )
            case PenumbraFigure():
                if isinstance(config.frame_sets[figure.frame_set], OwnFrames):
                    raise ValueError(
                        f"{key}.frame_set: {figure.frame_set!r} is of a user's own frames, which have "
                        "no scene to look at"
                    )
            case SoftRadiiFigure():
                if config.tables[figure.table].by != "radius":
                    raise ValueError(f"{key}.table: {figure.table!r} is not `by: radius`")
            case SoftTableFigure() | SoftPicturesFigure():
                _check_soft(config, key, figure)
            case NetworkFigure(kind="field_slice" | "field_3d"):
                encodings = {name: network_of(config, name).encoding for name in config.experiments}
                fields = [name for name, one in encodings.items() if one == "occupancy_field"]
                check_among(f"{key}.experiment", figure.experiment, fields)
            case ParetoFigure() | LearningCurvesFigure() | MethodsFigure():
                rows = rows_of(config, figure.table)
                scenes = list(dict.fromkeys(row["scene"] for row in rows))
                if figure.scene is not None or len(scenes) > 1:
                    check_among(f"{key}.scene", figure.scene or "", scenes)
                everything = figure.model_copy(update={"methods": None})
                drawn = [row["method"] for row in rows_of_figure(config, everything)]
                for method in getattr(figure, "methods", None) or []:
                    check_among(f"{key}.methods", method, drawn)
                seen = config.scenes[scene_of(config, figure)].view_sets
                for view_set in getattr(figure, "view_sets", []):
                    check_among(f"{key}.view_sets", view_set, seen)


def _check_soft(config: "Config", key: str, figure: SoftTableFigure | SoftPicturesFigure) -> None:
    table = config.tables[figure.table]
    frames = config.frame_sets[table.frame_set]
    if isinstance(frames, OwnFrames):
        raise ValueError(f"{key}.table: {figure.table!r} is of frames of a user's own")
    for k in getattr(figure, "radii", None) or []:
        if not 0 <= k < len(frames.radii):
            raise ValueError(
                f"{key}.radii: {k} is not among 0 to {len(frames.radii) - 1}, the radii of "
                f"{table.frame_set!r} counted from 0"
            )
    if isinstance(figure, SoftPicturesFigure):
        check_among(f"{key}.soft_scene", figure.soft_scene, measured_scenes(frames))
        for method in figure.methods:
            check_among(f"{key}.methods", method, table.asked)

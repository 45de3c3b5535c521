"""What tables, figures and claims are made of: methods of scenes, with their labels."""

from typing import TYPE_CHECKING, Any

from neural_shadows.config.claims import compared, scenes_of
from neural_shadows.config.experiments import formatted, network_of
from neural_shadows.config.figures import LossFigure, MethodsFigure, figure_scene
from neural_shadows.config.tables import RowSettings, method_key, row_label, rows_by_scene
from neural_shadows.evaluation.method_names import RAY_TRACED, experiment_of

if TYPE_CHECKING:
    from neural_shadows.config.whole import Config

Row = dict[str, Any]  # method, label, published, scene, experiment, bias


def rows_of(config: "Config", table: str) -> list[Row]:
    """The rows of a table; none of a table of costs.

    Returns: of each row `method`, the method's key; `label`; `published`, its key in
        published.csv or None if the table is not the thesis's; `scene`; `experiment`, or None
        if it is no network; `bias`, a number, `held_out`, or None if it is no network.
    """
    published = config.tables[table].published is not None
    return [
        _row(config, scene, row, (row.published or row.method) if published else None)
        for scene, rows in rows_by_scene(config, table).items()
        for row in rows
    ]


def _row(config: "Config", scene: str, row: RowSettings, published: str | None) -> Row:
    experiment = config.experiments.get(row.method)
    return {
        "method": method_key(config, row),
        "label": row_label(config, row),
        "published": published,
        "scene": scene,
        "experiment": row.method if experiment else None,
        "bias": (row.bias or experiment.bias) if experiment else None,
    }


def rows_of_figure(config: "Config", name: str) -> list[Row]:
    """The rows of a figure of a table: those of its scene, or of `widths` those with a `width`."""
    figure = config.figures[name]
    rows = rows_of(config, figure.table)
    if figure.kind == "widths":
        networks = [row for row in rows if row["experiment"]]
        widths = [
            network_of(config, row["experiment"]).model_dump().get("width") for row in networks
        ]
        return [row | {"width": width} for row, width in zip(networks, widths) if width]
    rows = [row for row in rows if row["scene"] == figure_scene(config, figure)]
    if isinstance(figure, MethodsFigure):
        # Ray tracing's pictures are the reference, which is shown anyway.
        rows = [row for row in rows if row["method"] != RAY_TRACED]
        if figure.methods is not None:
            rows = [row for row in rows if row["method"] in figure.methods]
    return rows


def curves_of(config: "Config", figure: LossFigure) -> list[dict[str, str]]:
    """The curves of a figure of losses, each with `experiment` and `label`."""
    return [
        {"experiment": curve.experiment, "label": formatted(config, curve.experiment, curve.label)}
        for curve in figure.curves
    ]


def rows_of_claim(config: "Config", name: str) -> list[list[Row]]:
    """The methods that a claim compares: a pair each, or each alone (`larger_error`)."""
    return [
        [_method_row(config, scene, key) for key, scene in scenes_of(config, methods).items()]
        for methods in compared(config.claims[name])
    ]


def _method_row(config: "Config", scene: str, key: str) -> Row:
    bias = "held_out" if experiment_of(key) != key else None
    return _row(config, scene, RowSettings(method=experiment_of(key), bias=bias), None)

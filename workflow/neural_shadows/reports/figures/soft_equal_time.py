"""Error over time of methods for soft shadows, one thread."""

from collections.abc import Sequence
from math import isnan
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import pandas as pd
from pydantic import Field

from neural_shadows.evaluation.null_predictors import is_null
from neural_shadows.evaluation.soft_registry import look_of
from neural_shadows.layout.layout import Layout
from neural_shadows.reports.data.lights import light_name
from neural_shadows.reports.data.table import read_table
from neural_shadows.reports.drawing import figure_inputs, style
from neural_shadows.reports.drawing.chart import add_tooltip, write_chart
from neural_shadows.reports.drawing.shown_errors import COLUMNS, with_shown_errors
from neural_shadows.reports.tables import soft_methods
from neural_shadows.running.stage import run_stage
from neural_shadows.sections.any_report import Chapter
from neural_shadows.sections.table_figures import RadiiFigure
from neural_shadows.settings.records import Run

if TYPE_CHECKING:
    from matplotlib.figure import Figure

NUMBERS = ("number", "radius", "ms", *COLUMNS)


class Settings(RadiiFigure):
    """Error over milliseconds of methods for soft shadows."""

    tables = (soft_methods.Settings,)
    chapter: ClassVar[Chapter] = "soft"

    kind: Literal["soft_equal_time"] = Field(description="`soft_equal_time`")
    radii: list[int] | None = Field(
        None,
        min_length=1,
        description="numbers of radii, counted from 0; by default all but a point light",
    )


files = figure_inputs.table_csv


def params(layout: Layout, figure: str) -> dict[str, Any]:
    return {"radii": layout.entry("figures", figure)["radii"], "run": layout.run()}


def draw(
    table: Path, png: Path, svg: Path, *, title: str, radii: Sequence[int] | None, run: Run
) -> None:
    """Draw a panel for each radius.

    Args:
        table: the CSV of a table of soft methods.
        radii: numbers of its radii, counted from 0; None for all but a point light.

    Raises:
        InputError: the table is missing or not whole.
    """
    rows = read_table(table, ("method", "label", "unit"), NUMBERS)
    if radii is None:
        radii = rows["number"][rows["radius"] > 0].unique() if rows["radius"].any() else [0]
    figure = equal_time_figure(rows, radii, title=f"{title} ({run['scale']} scale)")
    write_chart(figure, png, svg)


def equal_time_figure(table: pd.DataFrame, radii: Sequence[float], *, title: str) -> "Figure":
    """Draw squared error over a frame's milliseconds by radius.

    Args:
        table: `method`, `label`, `number` (of the radius), `radius`, `unit`, `ms` and `COLUMNS`.
        radii: numbers of those to draw.
    """
    from matplotlib.lines import Line2D

    from neural_shadows.reports.drawing.point_labels import label_points

    table, name = with_shown_errors(table)
    figure = style.new_figure(title, 5.2 * len(radii), 5.2)
    panels = figure.subplots(1, len(radii), sharex=True, sharey=True, squeeze=False)[0]
    looks = dict.fromkeys(look_of(method) for method in table["method"] if not is_null(method))
    entries = [
        Line2D([], [], label=look.name, color=look.colour, marker=look.marker, linestyle="")
        for look in looks
    ]
    style.legend_below(figure, entries, len(radii))  # a name is half a panel wide
    panel_rows = []
    for axes, number in zip(panels, radii):
        rows = table[(table["number"] == number) & (table["method"] != "all_dark")]
        methods = rows.dropna(subset="ms")
        for row in methods.itertuples():
            look = look_of(row.method)
            spread = [[row.error - row.error_low], [row.error_high - row.error]]
            drawn = {"color": look.colour, "marker": look.marker, "linestyle": "", "capsize": 2}
            bar = axes.errorbar(row.ms, row.error, spread, **drawn)
            ends = f" [{1e4 * row.error_low:.1f}, {1e4 * row.error_high:.1f}]"
            ends = "" if isnan(row.error_low) else ends  # of a single frame
            error = f"{1e4 * row.error:.1f}{ends}"
            add_tooltip(bar.lines[0], f"{row.label}: {name} {error} × 10⁻⁴; {row.ms:.1f} ms")
        for look in (look for look in looks if look.joined):
            joined = methods[methods["method"].map(look_of) == look].sort_values("ms")
            axes.plot(joined["ms"], joined["error"], color=look.colour, linewidth=0.8, zorder=0)
        for row in rows[rows["method"] == "no_shadow"].itertuples():
            axes.axhline(row.error, color="#777777", linewidth=0.7, linestyle=":", zorder=0)
            look = {"transform": axes.get_yaxis_transform(), "ha": "right", "va": "bottom"}
            axes.text(0.99, row.error, row.label, fontsize=7, **look)
        axes.set(xscale="log", yscale="log", xlabel="ms a frame, one thread")
        radius, unit = rows["radius"].iloc[0], rows["unit"].iloc[0]
        axes.set_title(light_name(radius, unit), fontsize=11)
        axes.grid(**style.GRID)
        style.plain_numbers(axes.xaxis)
        panel_rows.append((axes, methods))
    panels[0].set_ylabel(f"{name} of visibility, lower is better\n(bars: 95 % intervals)")
    figure.draw_without_rendering()  # names are placed when the layout is done
    for axes, methods in panel_rows:
        label_points(axes, methods[["ms", "error"]].to_numpy(), [*methods["label"]], fontsize=7)
    return figure


if "snakemake" in globals():
    run_stage(snakemake, draw)

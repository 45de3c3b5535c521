"""Error over time of methods for soft shadows, one thread."""

from collections.abc import Sequence
from math import ceil, isnan
from pathlib import Path
from typing import Literal

import pandas as pd
from pydantic import Field

from neural_shadows.evaluation.null_predictors import NO_SHADOW
from neural_shadows.evaluation.registry import is_network, look_of
from neural_shadows.reports.data.frame_means import ERROR_COLUMNS, with_shown_errors
from neural_shadows.reports.data.lights import light_name
from neural_shadows.reports.data.table import read_table
from neural_shadows.reports.drawing import style
from neural_shadows.reports.drawing.chart import point_with_interval
from neural_shadows.reports.drawing.style import Figure
from neural_shadows.reports.tables import soft_methods
from neural_shadows.sections.table_figures import RadiiFigure

NUMBERS = ("number", "radius", "ms", *ERROR_COLUMNS)


class Settings(RadiiFigure):
    """Error over milliseconds of methods for soft shadows."""

    tables = (soft_methods.Settings,)
    own_chapter = "costs"
    kind: Literal["soft_equal_time"] = Field(description="`soft_equal_time`")
    radii: list[int] | None = Field(
        None,
        min_length=1,
        description="numbers of radii, counted from 0; by default all but a point light",
    )


def draw(table_csv: Path, heading: str, radii: Sequence[int] | None) -> Figure:
    """Draw a panel for each radius.

    Args:
        radii: numbers of its radii, counted from 0; None for all but a point light.
    """
    rows = read_table(table_csv, ("method", "label", "unit"), NUMBERS)
    if radii is None:
        radii = rows["number"][rows["radius"] > 0].unique() if rows["radius"].any() else [0]
    return equal_time_figure(rows, radii, title=heading)


def equal_time_figure(table: pd.DataFrame, radii: Sequence[float], *, title: str) -> Figure:
    """Draw squared error over a frame's milliseconds by radius.

    Args:
        table: `method`, `label`, `number` (of the radius), `radius`, `unit`, `ms` and `ERROR_COLUMNS`.
        radii: numbers of those to draw.
    """
    from matplotlib.lines import Line2D

    table, name = with_shown_errors(table[table["number"].isin(radii)])
    table[["error", "error_low", "error_high"]] *= 1e4  # as in the tables
    looks = dict.fromkeys(map(look_of, table.dropna(subset="ms")["method"]))
    entries = [
        Line2D([], [], label=look.name, color=look.colour, marker=look.marker, linestyle="")
        for look in looks
    ]
    height = 5.0 + 0.22 * ceil(len(entries) / len(radii))  # a name is half a panel wide
    figure = style.new_figure(title, 5.2 * len(radii), height)
    style.legend_below(figure, entries, len(radii))
    panels = figure.subplots(1, len(radii), sharex=True, sharey=True, squeeze=False)[0]
    panel_rows = []
    for axes, number in zip(panels, radii):
        rows = table[table["number"] == number]
        methods = rows.dropna(subset="ms")  # null predictors have none
        for row in methods.itertuples():
            look = look_of(row.method)
            ends = row.error_low, row.error_high
            interval = "" if isnan(ends[0]) else f" [{ends[0]:.1f}, {ends[1]:.1f}]"
            error = f"{row.error:.1f}{interval}"  # of a single frame without one
            text = f"{row.label}: {name} {error} × 10⁻⁴; {row.ms:.1f} ms"
            drawn = {"color": look.colour, "marker": look.marker}
            point_with_interval(axes, row.ms, row.error, ends, text, **drawn)
        for look in (look for look in looks if look.joined):
            joined = methods[methods["method"].map(look_of) == look].sort_values("ms")
            axes.plot(joined["ms"], joined["error"], color=look.colour, linewidth=0.8, zorder=0)
        # A line ten times above all methods would take half the height from their names.
        null = rows["error"][rows["method"] == NO_SHADOW]
        far = f" (no shadow: {null.iloc[0]:,.0f})" if len(null) else ""
        axes.set(xscale="log", yscale="log", xlabel="ms a frame, one thread")
        radius, unit = rows["radius"].iloc[0], rows["unit"].iloc[0]
        axes.set_title(light_name(radius, unit) + far, fontsize=11)
        axes.grid(**style.GRID)
        for axis in (axes.xaxis, axes.yaxis):
            style.plain_numbers(axis)
        # Where names have no room those of networks stay, if farther off.
        placed = methods.sort_values(
            "method", key=lambda keys: ~keys.map(is_network), kind="stable"
        )
        panel_rows.append((axes, placed[["ms", "error", "label"]]))
    panels[0].set_ylabel(f"{name} of visibility, × 10⁻⁴,\nlower is better (bars: 95 % intervals)")
    networks = table.loc[table["method"].map(is_network), "method"].nunique()
    style.label_panels(panel_rows, 7, far=networks)
    return figure

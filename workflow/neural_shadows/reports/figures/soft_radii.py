"""Error over light radius [Hu et al. 2025, figure 9]."""

from itertools import product
from pathlib import Path
from typing import Literal

import pandas as pd
from pydantic import Field

from neural_shadows.evaluation.look import COLOURS
from neural_shadows.evaluation.registry import look_of
from neural_shadows.reports.data.frame_means import ERROR_COLUMNS, with_shown_errors
from neural_shadows.reports.data.table import read_table
from neural_shadows.reports.drawing import style
from neural_shadows.reports.drawing.chart import add_tooltip
from neural_shadows.reports.drawing.style import Axes, Figure
from neural_shadows.reports.tables import soft_summary
from neural_shadows.sections.sections import Sections
from neural_shadows.sections.table_figures import TableFigure
from neural_shadows.settings.base import Name

NUMBERS = ("radius", *ERROR_COLUMNS)
LINES = ("-", "--", ":")  # after all colours once, twice
NAME = 0.045  # height of a line's name, a share of the axes'


class Settings(TableFigure):
    """Error over the light's radius of soft-shadow methods."""

    tables = (soft_summary.Settings,)
    kind: Literal["soft_radii"] = Field(description="`soft_radii`")
    table: Name = Field(description="a table of `soft_summary` in `tables`, `by: radius`")

    def check(self, config: Sections, key: str) -> None:
        super().check(config, key)
        if config.tables[self.table].by != "radius":
            raise ValueError(f"{key}.table: {self.table!r} is not by radius. Set its `by: radius`")


def draw(table_csv: Path, heading: str) -> Figure:
    """Draw the CSV of a table of `soft_summary`, by radius."""
    rows = read_table(table_csv, ("method", "label", "unit"), NUMBERS)
    return radii_figure(rows, title=heading)


def radii_figure(table: pd.DataFrame, *, title: str) -> Figure:
    """Draw mean squared errors over radius, with 95 % intervals.

    Args:
        table: `method`, `label`, `radius`, `unit` and `ERROR_COLUMNS`.
    """
    table, name = with_shown_errors(table)
    table[["error", "error_low", "error_high"]] *= 1e4  # as in the tables
    figure = style.new_figure(title, 9.5, 5.4)
    axes = figure.subplots()
    measured = table.dropna(subset="error")
    looks, ends = product(LINES, COLOURS), []
    for (method, rows), (line, colour) in zip(measured.groupby("method", sort=False), looks):
        marker, label = look_of(method).marker, rows["label"].iloc[0]
        drawn = {"color": colour, "linestyle": line, "marker": marker, "markersize": 7}
        spread = [rows["error"] - rows["error_low"], rows["error_high"] - rows["error"]]
        bars = axes.errorbar(rows["radius"], rows["error"], spread, capsize=2, **drawn)
        values = ", ".join(f"{error:.1f}" for error in rows["error"])
        add_tooltip(bars.lines[0], f"{label}: {name} {values} × 10⁻⁴ by radius")
        ends.append((label, colour, *rows[["radius", "error"]].iloc[-1]))
    axes.set(yscale="log", xlabel=f"radius of the light, {measured['unit'].iloc[0]}")
    axes.set_ylabel(f"{name} of visibility, × 10⁻⁴,\nlower is better (bars: 95 % intervals)")
    style.plain_numbers(axes.yaxis)
    axes.grid(**style.GRID)
    _name_lines(axes, ends)
    return figure


def _name_lines(axes: Axes, ends: list[tuple[str, str, float, float]]) -> None:
    """Write names beside the right ends of lines, apart from each other.

    Args:
        ends: name, colour, radius and error of each.
    """
    ends = sorted(ends, key=lambda end: end[3])
    axes.get_figure().draw_without_rendering()  # for the scale of errors
    to_share = axes.transData + axes.transAxes.inverted()
    heights = [to_share.transform((radius, error))[1] for *_, radius, error in ends]
    for k in range(1, len(ends)):
        heights[k] = max(heights[k], heights[k - 1] + NAME)
    for k, height in enumerate(heights):
        heights[k] = min(height, 1 - NAME * (len(ends) - 1 - k))
    for (label, colour, radius, error), height in zip(ends, heights):
        line = {"arrowstyle": "-", "color": colour, "linewidth": 0.6, "relpos": (0, 0.5)}
        axes.annotate(
            label,
            (radius, error),
            (1.06, height),
            textcoords="axes fraction",
            va="center",
            color=colour,
            fontsize=9,
            arrowprops=line,
        )

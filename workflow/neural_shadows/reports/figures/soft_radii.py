"""Error over light radius [Hu et al. 2025, figure 9]."""

from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar, Literal

import pandas as pd
from pydantic import Field

from neural_shadows.evaluation.look import COLOURS
from neural_shadows.evaluation.soft_registry import look_of
from neural_shadows.reports.data.table import read_table
from neural_shadows.reports.drawing import figure_inputs, style
from neural_shadows.reports.drawing.chart import add_tooltip, write_chart
from neural_shadows.reports.drawing.shown_errors import COLUMNS, with_shown_errors
from neural_shadows.reports.tables import soft_summary
from neural_shadows.running.stage import run_stage
from neural_shadows.sections.any_report import Chapter
from neural_shadows.sections.sections import Sections
from neural_shadows.sections.table_figures import TableFigure
from neural_shadows.settings.base import Name
from neural_shadows.settings.records import Run

if TYPE_CHECKING:
    from matplotlib.figure import Figure

NUMBERS = ("radius", *COLUMNS)
LINES = ("-", "--", ":")  # after all colours once, twice


class Settings(TableFigure):
    """Error over the light's radius of soft-shadow methods."""

    tables = (soft_summary.Settings,)
    chapter: ClassVar[Chapter] = "soft"

    kind: Literal["soft_radii"] = Field(description="`soft_radii`")
    table: Name = Field(description="a table of `soft_summary` in `tables`, `by: radius`")

    def check(self, config: Sections, key: str) -> None:
        super().check(config, key)
        if config.tables[self.table].by != "radius":
            raise ValueError(f"{key}.table: {self.table!r} is not by radius. Set its `by: radius`")


files = figure_inputs.table_csv
params = figure_inputs.run


def draw(table: Path, png: Path, svg: Path, *, title: str, run: Run) -> None:
    """Draw the CSV of a table of `soft_summary`, by radius.

    Raises:
        InputError: it is missing or not whole.
    """
    rows = read_table(table, ("method", "label", "unit"), NUMBERS)
    write_chart(radii_figure(rows, title=f"{title} ({run['scale']} scale)"), png, svg)


def radii_figure(table: pd.DataFrame, *, title: str) -> "Figure":
    """Draw mean squared errors over radius, with 95 % intervals.

    Args:
        table: `method`, `label`, `radius`, `unit` and `COLUMNS`.
    """
    table, name = with_shown_errors(table)
    figure = style.new_figure(title, 8, 5.4)
    axes = figure.subplots()
    measured = table.dropna(subset="error")
    looks = product(LINES, COLOURS)
    for (method, rows), (line, colour) in zip(measured.groupby("method", sort=False), looks):
        marker, label = look_of(method).marker, rows["label"].iloc[0]
        drawn = {"color": colour, "linestyle": line, "marker": marker, "markersize": 5}
        drawn["label"] = label
        spread = [rows["error"] - rows["error_low"], rows["error_high"] - rows["error"]]
        bars = axes.errorbar(rows["radius"], rows["error"], spread, capsize=2, **drawn)
        values = ", ".join(f"{1e4 * error:.1f}" for error in rows["error"])
        add_tooltip(bars.lines[0], f"{label}: {name} {values} × 10⁻⁴ by radius")
    axes.set(yscale="log", xlabel=f"radius of the light, {measured['unit'].iloc[0]}")
    axes.set_ylabel(f"{name} of visibility, lower is better\n(bars: 95 % intervals)")
    axes.grid(**style.GRID)
    style.legend_below(figure, columns=3)
    return figure


if "snakemake" in globals():
    run_stage(snakemake, draw)

"""Error over the light's radius, a line a method (Hu et al. 2025, figure 9)."""

from itertools import product
from pathlib import Path

import pandas as pd
from matplotlib.figure import Figure

from neural_shadows.reports.figures import style
from neural_shadows.reports.figures.chart import say, write_chart
from neural_shadows.reports.figures.shown_errors import COLUMNS, with_shown_errors
from neural_shadows.reports.soft_looks import SOFT_LOOKS, family_of
from neural_shadows.reports.tables.writing import read_table
from neural_shadows.running.stage import run_stage

NUMBERS = ("radius", *COLUMNS)
LINES = ("-", "--", ":")  # when all colours are taken once, twice


def draw(table: Path, png: Path, svg: Path, *, title: str, run: style.Section) -> None:
    """Draw the CSV of a table of `soft_summary` that is by radius.

    Raises:
        InputError: it is missing or not whole.
    """
    found = read_table(table, ("method", "label", "unit"), NUMBERS)
    write_chart(radii_figure(found, title=f"{title} ({run['scale']} scale)"), png, svg)


def radii_figure(table: pd.DataFrame, *, title: str) -> Figure:
    """Mean squared error (logarithmic) over the radius, with its 95 % intervals.

    Args:
        table: `method`, `label`, `radius`, `unit` and `COLUMNS`.
    """
    table, name = with_shown_errors(table)
    figure = style.new_figure(title, 8, 5.4)
    axes = figure.subplots()
    known = table.dropna(subset="error")
    looks = product(LINES, style.COLOURS)
    for (method, rows), (line, colour) in zip(known.groupby("method", sort=False), looks):
        marker, label = SOFT_LOOKS[family_of(method)].marker, rows["label"].iloc[0]
        drawn = {"color": colour, "linestyle": line, "marker": marker, "markersize": 5}
        drawn["label"] = label
        spread = [rows["error"] - rows["error_low"], rows["error_high"] - rows["error"]]
        bars = axes.errorbar(rows["radius"], rows["error"], spread, capsize=2, **drawn)
        values = ", ".join(f"{1e4 * one:.1f}" for one in rows["error"])
        say(bars.lines[0], f"{label}: {name} {values} × 10⁻⁴ by radius")
    axes.set(yscale="log", xlabel=f"radius of the light, {known['unit'].iloc[0]}")
    axes.set_ylabel(f"{name} of visibility, lower is better\n(bars: 95 % intervals)")
    axes.grid(**style.GRID)
    style.legend_below(figure, most=3)
    return figure


if "snakemake" in globals():
    run_stage(snakemake, draw)

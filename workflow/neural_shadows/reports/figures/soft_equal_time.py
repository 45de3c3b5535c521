"""Error over milliseconds of every method for soft shadows, on one thread of one device."""

from collections.abc import Sequence
from math import isnan
from pathlib import Path

import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from neural_shadows.evaluation.soft_method_names import DENOISERS
from neural_shadows.reports.figures import style
from neural_shadows.reports.figures.chart import say, write_chart
from neural_shadows.reports.figures.point_labels import label_points
from neural_shadows.reports.figures.shown_errors import COLUMNS, with_shown_errors
from neural_shadows.reports.soft_looks import SOFT_LOOKS, family_of, light_name
from neural_shadows.reports.tables.writing import read_table
from neural_shadows.running.stage import run_stage

NUMBERS = ("number", "radius", "ms", *COLUMNS)
JOINED = ("rt", "field", *DENOISERS)  # one method with more and more rays


def draw(
    table: Path,
    png: Path,
    svg: Path,
    *,
    title: str,
    radii: Sequence[int] | None,
    run: style.Section,
) -> None:
    """Draw a panel for each radius.

    Args:
        table: the CSV of a table of soft methods.
        radii: which of its radii, counted from 0; None for all but a point light.

    Raises:
        InputError: the table is missing or not whole.
    """
    found = read_table(table, ("method", "label", "unit"), NUMBERS)
    if radii is None:
        radii = found["number"][found["radius"] > 0].unique() if found["radius"].any() else [0]
    figure = equal_time_figure(found, radii, title=f"{title} ({run['scale']} scale)")
    write_chart(figure, png, svg)


def equal_time_figure(table: pd.DataFrame, radii: Sequence[float], *, title: str) -> Figure:
    """A panel for each radius: mean squared error over milliseconds of a frame, both logarithmic.

    Args:
        table: `method`, `label`, `number` (of the radius), `radius`, `unit`, `ms` and `COLUMNS`.
        radii: numbers of those to draw.
    """
    table, name = with_shown_errors(table)
    figure = style.new_figure(title, 5.2 * len(radii), 5.2)
    panels = figure.subplots(1, len(radii), sharex=True, sharey=True, squeeze=False)[0]
    families = {family_of(method) for method in table["method"]} - {"null"}
    entries = [
        Line2D([], [], label=look.name, color=look.colour, marker=look.marker, linestyle="")
        for family, look in SOFT_LOOKS.items()
        if family in families
    ]
    style.legend_below(figure, entries, len(radii))  # a name is half a panel wide
    named = []
    for axes, number in zip(panels, radii):
        rows = table[(table["number"] == number) & (table["method"] != "all_dark")]
        methods = rows.dropna(subset="ms")
        for row in methods.itertuples():
            look = SOFT_LOOKS[family_of(row.method)]
            spread = [[row.error - row.error_low], [row.error_high - row.error]]
            drawn = {"color": look.colour, "marker": look.marker, "linestyle": "", "capsize": 2}
            bar = axes.errorbar(row.ms, row.error, spread, **drawn)
            ends = f" [{1e4 * row.error_low:.1f}, {1e4 * row.error_high:.1f}]"
            ends = "" if isnan(row.error_low) else ends  # of a single frame
            error = f"{1e4 * row.error:.1f}{ends}"
            say(bar.lines[0], f"{row.label}: {name} {error} × 10⁻⁴; {row.ms:.1f} ms")
        for family in JOINED:
            some = methods[methods["method"].map(family_of) == family].sort_values("ms")
            look = SOFT_LOOKS[family]
            axes.plot(some["ms"], some["error"], color=look.colour, linewidth=0.8, zorder=0)
        for row in rows[rows["method"] == "no_shadow"].itertuples():
            axes.axhline(row.error, color="#777777", linewidth=0.7, linestyle=":", zorder=0)
            place = axes.get_yaxis_transform()
            axes.text(
                0.99, row.error, row.label, transform=place, ha="right", va="bottom", fontsize=7
            )
        axes.set(xscale="log", yscale="log", xlabel="ms a frame, one thread")
        radius, unit = rows["radius"].iloc[0], rows["unit"].iloc[0]
        axes.set_title(light_name(radius, unit), fontsize=11)
        axes.grid(**style.GRID)
        style.plain_numbers(axes.xaxis)
        named.append((axes, methods))
    panels[0].set_ylabel(f"{name} of visibility, lower is better\n(bars: 95 % intervals)")
    figure.draw_without_rendering()  # names are placed when the layout is done
    for axes, methods in named:
        label_points(axes, methods[["ms", "error"]].to_numpy(), [*methods["label"]], fontsize=7)
    return figure


if "snakemake" in globals():
    run_stage(snakemake, draw)

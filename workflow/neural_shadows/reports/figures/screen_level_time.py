"""Time of a screen-space network by level and part."""

from pathlib import Path
from typing import Literal

import pandas as pd
from pydantic import Field

from neural_shadows.evaluation.look import COLOURS
from neural_shadows.reports.data.digits import short
from neural_shadows.reports.data.phrases import TEXTS
from neural_shadows.reports.data.table import read_table
from neural_shadows.reports.drawing.chart import add_tooltip
from neural_shadows.reports.drawing.style import GRID, Axes, Figure, legend_below, new_figure
from neural_shadows.reports.tables import screen_parts
from neural_shadows.reports.tables.screen_parts import NAMES, PRINTED
from neural_shadows.sections.table_figures import TableFigure

NUMBERS = ("level", "ms", "share", "printed_ms", "printed_share")
PARTS = (*PRINTED, "extraction", "entrance", "exit")  # in the order of their colours


class Settings(TableFigure):
    """Time of a screen-space network, by level and part."""

    tables = (screen_parts.Settings,)
    kind: Literal["screen_level_time"] = Field(description="`screen_level_time`")


def draw(table_csv: Path, heading: str) -> Figure:
    """Draw the CSV of a table of `screen_parts`."""
    parts = read_table(table_csv, ("part", "run"), NUMBERS)
    return level_figure(parts, title=heading)


def level_figure(table: pd.DataFrame, *, title: str) -> Figure:
    """Draw shares of time by level, ours and the paper's."""
    panels = {f"ours, {table['run'].iloc[0]}": ("share", "ms")}
    if table["printed_ms"].notna().any():
        panels[f"{TEXTS['nsm']}, RTX 2080 Ti"] = ("printed_share", "printed_ms")
    figure = new_figure(title, 5 * len(panels), 4.6)
    for axes, (name, columns) in zip(
        figure.subplots(1, len(panels), sharey=True, squeeze=False)[0], panels.items()
    ):
        _draw_levels(axes, table, *columns)
        axes.set_title(f"{name}: {short(table[columns[1]].sum(), 4)} ms", fontsize=11)
    figure.axes[0].set_ylabel("share of the whole time, %")
    legend_below(figure)
    return figure


def _draw_levels(axes: Axes, table: pd.DataFrame, share: str, ms: str) -> None:
    levels = sorted(table["level"].unique())
    bottom = pd.Series(0.0, index=levels)
    for part, colour in zip(PARTS, (*COLOURS, "#999999")):
        rows = table[table["part"] == part].set_index("level")
        heights = 100 * rows[share].reindex(levels).fillna(0)
        if heights.any():
            label = NAMES.get(part, part)
            bars = axes.bar(levels, heights, bottom=bottom, color=colour, label=label, width=0.7)
            for level, bar in zip(levels, bars):
                if heights[level]:
                    add_tooltip(bar, f"level {level:g}, {label}: {short(rows[ms][level])} ms")
            bottom += heights
    sums = table.groupby("level")[ms].sum()
    for level in levels:
        axes.annotate(
            f"{short(sums[level])} ms",
            (level, bottom[level]),
            xytext=(0, 2),
            textcoords="offset points",
            ha="center",
            fontsize=8,
        )
    axes.set(xlabel="level (0: the frame's own size)", xticks=levels)
    axes.margins(y=0.08)
    axes.grid(axis="y", **GRID)
    axes.set_axisbelow(True)

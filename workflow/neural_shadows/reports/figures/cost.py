"""How the cost of each stage grows, as a figure."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from neural_shadows.evaluation.costs import read_cost
from neural_shadows.reports.figures.style import COLOURS, DPI, write_strip
from neural_shadows.reports.tables.cost import cost_table

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def cost_figure(table: pd.DataFrame, *, title: str) -> Figure:
    """Draw seconds, and below them memory, over each size, both logarithmic."""
    from matplotlib.figure import Figure
    from matplotlib.ticker import EngFormatter, LogLocator, NullFormatter

    sizes = list(dict.fromkeys(table["over"]))
    stages = list(dict.fromkeys(table["stage"]))
    figure = Figure(figsize=(3.2 * len(sizes), 6.4), dpi=DPI, layout="constrained")
    panels = figure.subplots(2, len(sizes), squeeze=False, sharey="row")
    for column, over in enumerate(sizes):
        shown = table[table["over"] == over]
        # Less than two decades have too few powers of ten to read sizes from.
        narrow = shown["size"].max() < 100 * shown["size"].min()
        for row, (value, unit) in enumerate((("seconds", "s"), ("memory_mib", "MiB"))):
            axes = panels[row, column]
            for colour, stage in zip(COLOURS, stages):
                part = shown[(shown["stage"] == stage) & (shown[value] > 0)]
                if len(part):
                    label = f"{stage} ({part[f'{value}_exponent'].iloc[0]:.2f})"
                    axes.plot(part["size"], part[value], color=colour, marker="o", label=label)
            axes.set_xscale("log")
            axes.set_yscale("log")
            axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5) if narrow else (1,)))
            axes.xaxis.set_major_formatter(EngFormatter(sep=""))
            axes.xaxis.set_minor_formatter(NullFormatter())
            axes.grid(which="both", linewidth=0.4, alpha=0.4)
            axes.legend(fontsize="small")
            axes.set_xlabel(over)
            if column == 0:
                axes.set_ylabel(unit)
    figure.suptitle(
        f"{title}; exponents in brackets, 1 is linear", x=0.01, ha="left", weight="bold"
    )
    return figure


def write_cost_figure(
    costs: Sequence[Path], png: Path, svg: Path, *, title: str, scale: str
) -> None:
    """Draw the figure of these measurements."""
    table = cost_table([read_cost(path) for path in costs])
    write_strip(cost_figure(table, title=f"{title} ({scale} scale)"), png, svg)

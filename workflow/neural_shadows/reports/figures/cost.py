"""How the cost of each stage grows, as a figure."""

from pathlib import Path

import pandas as pd
from matplotlib.figure import Figure
from matplotlib.ticker import EngFormatter, NullLocator

from neural_shadows.files.whole_files import read_json
from neural_shadows.reports.digits import short
from neural_shadows.reports.figures.chart import saying_points, write_chart
from neural_shadows.reports.figures.style import COLOURS, GRID, Section, new_figure
from neural_shadows.reports.tables.cost import cost_table
from neural_shadows.running.stage import run_stage

UNITS = {"seconds": "seconds", "memory_mib": "peak memory, MiB"}


def draw(costs: list[Path], png: Path, svg: Path, *, title: str, run: Section) -> None:
    """Draw seconds, and below them memory, of the stages over each size that was measured."""
    table = cost_table([read_json(path) for path in costs])
    write_chart(cost_figure(table, title=f"{title} ({run['scale']} scale)"), png, svg)


def cost_figure(table: pd.DataFrame, *, title: str) -> Figure:
    """Draw the table of `cost_table`, both axes logarithmic."""
    sizes = table["over"].unique()
    colours = dict(zip(table["stage"].unique(), COLOURS))
    figure = new_figure(f"{title}; exponents in brackets, 1 is linear", 9.6, 4 * len(sizes))
    panels = figure.subplots(len(sizes), 2, squeeze=False, sharey="col")
    for column, (value, unit) in zip(panels.T, UNITS.items()):
        for axes, over in zip(column, sizes):
            shown = table[table["over"] == over]
            for stage, part in shown[shown[value] > 0].groupby("stage", sort=False):
                label = f"{stage} ({part[f'{value}_exponent'].iloc[0]:.2f})"
                axes.plot(part["size"], part[value], color=colours[stage], marker="o", label=label)
            axes.set(xscale="log", yscale="log", xlabel=over.replace("_", " "), ylabel=unit)
            axes.set_xticks(shown["size"].unique())
            axes.xaxis.set(major_formatter=EngFormatter(sep=""), minor_locator=NullLocator())
            for stage, part in shown[shown[value] > 0].groupby("stage", sort=False):
                texts = [
                    f"{stage}: {short(row[value])} {unit} at {row['size']:,}"
                    for _, row in part.iterrows()
                ]
                saying_points(axes, part["size"], part[value], texts, color=colours[stage])
            axes.grid(which="both", **GRID)
            # Above the panel, where it covers no line.
            axes.legend(fontsize="small", loc="lower left", bbox_to_anchor=(0, 1), frameon=False)
    return figure


if "snakemake" in globals():
    run_stage(snakemake, draw)

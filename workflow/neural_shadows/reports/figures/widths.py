"""Quality and frame time of networks over their layer width [figure 4.8]."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import pandas as pd
from matplotlib.figure import Figure

from neural_shadows.reports.figures import style
from neural_shadows.reports.tables.writing import read_table
from neural_shadows.running.stage import run_stage

# What is drawn, and between what it is spread.
SPREADS = {"lpips": ("lpips_low", "lpips_high"), "frame_ms": ("frame_ms_q1", "frame_ms_q3")}


def draw(
    table: Path,
    png: Path,
    svg: Path,
    *,
    title: str,
    rows: Sequence[style.Section],
    run: style.Section,
) -> None:
    """Draw the networks of a table of frame times.

    Args:
        table: its CSV.
        rows: the table's rows; those with a `width` (neurons per layer) are drawn.

    Raises:
        InputError: the table is missing or not whole.
    """
    spreads = [column for pair in SPREADS.values() for column in pair]
    theirs = [f"thesis_{column}" for column in SPREADS]
    times = read_table(table, ("method", "scene"), (*SPREADS, *spreads, *theirs))
    widths = {(row["scene"], row["label"]): row["width"] for row in rows if row["width"]}
    figure = width_figure(times, widths, title=f"{title} ({run['scale']} scale)")
    style.write_figure(figure, png, svg)


def width_figure(
    table: pd.DataFrame, widths: Mapping[tuple[str, str], int], *, title: str
) -> Figure:
    """Draw LPIPS and frame time over width, a line per scene, the thesis's numbers dashed.

    Args:
        table: of frame times, a row for each method and scene.
        widths: neurons per layer by scene and the label of the row.
    """
    width = [widths.get(key) for key in zip(table["scene"], table["method"])]
    shown = table.assign(width=width).dropna(subset="width").sort_values("width")
    figure = style.new_figure(title, 11, 4.8)
    quality, speed = figure.subplots(1, 2)
    for axes, (column, (low, high)) in zip((quality, speed), SPREADS.items()):
        for colour, (scene, rows) in zip(style.COLOURS, shown.groupby("scene", sort=False)):
            at, value, theirs = rows["width"], rows[column], rows[f"thesis_{column}"]
            spread = [value - rows[low], rows[high] - value]
            axes.errorbar(at, value, spread, color=colour, marker="o", capsize=3, label=scene)
            if theirs.notna().any():
                look = {"color": colour, "marker": "s", "linestyle": "--"}
                axes.plot(at, theirs, label=f"{scene}, thesis", **look)
        axes.set_xscale("log", base=2)
        ticks = sorted(set(shown["width"].astype(int)))
        axes.set_xticks(ticks, ticks)
        axes.set_xlabel("neurons per layer")
        axes.grid(**style.GRID)
    quality.set_ylabel("LPIPS, mean [95 % interval]")
    quality.set_ylim(bottom=0)
    if shown["thesis_lpips"].notna().any():
        note = "the thesis does not say which network its LPIPS is of: compare slopes"
        quality.set_title(note, fontsize=9)
    speed.set_ylabel("frame time, ms, median [quartiles]")
    speed.set_yscale("log")  # ours and the thesis's machine may be far apart
    style.plain_numbers(speed.yaxis)
    style.legend_below(figure)
    return figure


if "snakemake" in globals():
    run_stage(snakemake, draw)

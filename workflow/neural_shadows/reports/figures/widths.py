"""Quality and frame time of networks over their layer width [figure 4.8]."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from neural_shadows.reports.figures.style import COLOURS, DPI, write_strip
from neural_shadows.reports.tables.writing import read_table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# What is drawn, and between what it is spread.
SPREADS = {"lpips": ("lpips_low", "lpips_high"), "frame_ms": ("frame_ms_q1", "frame_ms_q3")}


def width_figure(table: pd.DataFrame, widths: Mapping[str, int], *, title: str) -> Figure:
    """Draw LPIPS and frame time over width, a line per scene, the thesis's numbers dashed.

    Args:
        table: as `performance_table` gives it.
        widths: neurons per layer by the label of the row; rows without one are left out.
    """
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

    shown = table[table["method"].isin(widths)]
    shown = shown.assign(width=shown["method"].map(widths)).sort_values("width")
    figure = Figure(figsize=(11, 4.6), dpi=DPI, layout="constrained")
    quality, speed = figure.subplots(1, 2)
    scenes = list(dict.fromkeys(shown["scene"]))
    for axes, (column, (low, high)) in zip((quality, speed), SPREADS.items()):
        for colour, scene in zip(COLOURS, scenes):
            rows = shown[shown["scene"] == scene]
            spread = [rows[column] - rows[low], rows[high] - rows[column]]
            axes.errorbar(rows["width"], rows[column], spread, color=colour, marker="o", capsize=3)
            axes.plot(
                rows["width"], rows[f"thesis_{column}"], color=colour, marker="s", linestyle="--"
            )
        axes.set_xscale("log", base=2)
        axes.set_xticks(sorted(set(shown["width"])), sorted(set(shown["width"])))
        axes.set_xlabel("neurons per layer")
        axes.grid(linewidth=0.4, alpha=0.4)
    quality.set_ylabel("LPIPS, mean [95 % interval]")
    quality.set_ylim(bottom=0)
    speed.set_ylabel("frame time, ms, median [quartiles]")
    speed.set_yscale("log")  # ours and the thesis's machine may be far apart
    figure.legend(
        handles=[
            *(Line2D([], [], color=c, marker="o", label=s) for c, s in zip(COLOURS, scenes)),
            Line2D([], [], color="grey", marker="o", label="ours"),
            Line2D([], [], color="grey", marker="s", linestyle="--", label="thesis"),
        ],
        loc="outside lower center",
        ncols=len(scenes) + 2,
    )
    figure.suptitle(title, x=0.01, ha="left", weight="bold")
    return figure


def read_frame_time_table(table_csv: Path) -> pd.DataFrame:
    """Read a table of `write_performance_table`.

    Raises:
        InputError: it is missing or not whole.
    """
    spreads = [column for pair in SPREADS.values() for column in pair]
    theirs = [f"thesis_{column}" for column in SPREADS]
    return read_table(table_csv, ("method", "scene"), (*SPREADS, *spreads, *theirs))


def write_width_figure(
    table_csv: Path,
    png: Path,
    svg: Path,
    *,
    title: str,
    rows: Sequence[Mapping[str, str | None]],
    widths: Mapping[str, int],
    scale: str,
) -> None:
    """Draw the figure of a table of frame times.

    Args:
        table_csv: as `write_performance_table` wrote it.
        rows: the table's rows: `method` and `label`.
        widths: neurons per layer by experiment.

    Raises:
        InputError: the table is not whole.
    """
    table = read_frame_time_table(table_csv)
    by_label = {row["label"]: widths[row["method"]] for row in rows if row["method"] in widths}
    write_strip(width_figure(table, by_label, title=f"{title} ({scale} scale)"), png, svg)

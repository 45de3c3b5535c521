"""Quality and time of networks over width [figure 4.8]."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

import pandas as pd
from pydantic import Field

from neural_shadows.evaluation.look import COLOURS, GREY
from neural_shadows.reports.data.digits import short
from neural_shadows.reports.data.table import read_table, with_ends
from neural_shadows.reports.data.timing import FRAME_MS, OWN_MS
from neural_shadows.reports.drawing import style
from neural_shadows.reports.drawing.chart import add_tooltip
from neural_shadows.reports.drawing.style import Axes, Figure
from neural_shadows.reports.tables import frame_times
from neural_shadows.sections.sections import Sections
from neural_shadows.sections.table_figures import TableFigure
from neural_shadows.settings.records import Row

THEIRS = ("thesis_lpips", "thesis_frame_ms")
MARKERS = "os^v"


class Settings(TableFigure):
    """Quality and times over layer width [figure 4.8]."""

    tables = (frame_times.Settings,)

    kind: Literal["widths"] = Field(description="`widths`")

    def resolved(self, config: Sections) -> dict[str, Any]:
        """The settings with `rows`, networks with a `width`."""
        rows = []
        for row in config.tables[self.table].resolved_rows(config):
            network = row["experiment"] and config.network_of(row["experiment"])
            if width := getattr(network, "width", None):
                rows.append(row | {"width": width})
        return self.model_dump() | {"rows": rows}


def draw(table_csv: Path, rows: Sequence[Row], heading: str) -> Figure:
    """Draw the networks of a table of frame times.

    Args:
        rows: the table's rows; those with a `width` (neurons per layer) are drawn.
    """
    numbers = (*with_ends("lpips"), *FRAME_MS, *OWN_MS, *THEIRS)
    times = read_table(table_csv, ("method", "scene", "lpips_net", "learned"), numbers)
    widths = {(row["scene"], row["label"]): row["width"] for row in rows if row["width"]}
    return width_figure(times, widths, title=heading)


def width_figure(
    table: pd.DataFrame, widths: Mapping[tuple[str, str], int], *, title: str
) -> Figure:
    """Draw LPIPS and times over width, a line per scene.

    The thesis's numbers are dashed and grey. Its LPIPS is of another network, with axes
    of its own. Unlearned networks are hollow. Without LPIPS there are no axes for it.

    Args:
        table: of frame times, a row for each method and scene.
        widths: neurons per layer by scene and the label of the row.
    """
    width = [widths.get(key) for key in zip(table["scene"], table["method"])]
    shown = table.assign(width=width).dropna(subset="width").sort_values("width")
    printed = shown["thesis_lpips"].notna().any()
    measured = shown["lpips"].notna().any()
    counts = int(measured), int(printed), 1
    figure = style.new_figure(title, 1.6 + 4.6 * sum(counts), 4.8)
    panels = iter(figure.subplots(1, sum(counts), squeeze=False)[0])
    quality, theirs, (speed,) = ([next(panels) for _ in range(count)] for count in counts)
    for i, (scene, rows) in enumerate(shown.groupby("scene", sort=False)):
        colour = COLOURS[i % len(COLOURS)]
        for axes in quality:
            _draw_line(axes, rows, with_ends("lpips"), color=colour, label=scene)
        _draw_line(speed, rows, FRAME_MS, color=colour, label=scene)
        own = "own time, without the rest of the frame" if i == 0 else ""  # once in the legend
        _draw_line(speed, rows, OWN_MS, color=colour, linestyle=":", label=own)
        look = {"color": GREY, "linestyle": "--", "marker": MARKERS[i % len(MARKERS)]}
        for axes, column in zip((*theirs, speed), THEIRS if printed else THEIRS[1:]):
            if rows[column].notna().any():
                axes.plot(rows["width"], rows[column], label=f"{scene}, thesis", **look)
    ticks = sorted(set(shown["width"].astype(int)))
    for axes in (*quality, *theirs, speed):
        axes.set_xscale("log", base=2)
        axes.set_xticks(ticks, ticks)
        axes.set_xlabel("neurons per layer")
        axes.grid(**style.GRID)
    for axes in (*quality, *theirs):
        axes.set_ylim(bottom=0)
    for axes in quality:
        axes.set_ylabel(f"LPIPS ({shown['lpips_net'].iloc[0]}), mean [95 % interval]")
    for axes in theirs:
        axes.set_ylabel("LPIPS as the thesis prints it", color=GREY)
        axes.set_title("another LPIPS network: compare slopes only", fontsize=9, color=GREY)
    speed.set_ylabel("frame time, ms, median [quartiles]")
    speed.set_yscale("log")  # ours and the thesis's machine may be far apart
    style.plain_numbers(speed.yaxis)
    style.legend_below(figure, style.hollow(shown))
    return figure


def _draw_line(axes: Axes, rows: pd.DataFrame, columns: Sequence[str], **look: str) -> None:
    """Draw a value's interval over width, hollow if not learned."""
    value, low, high = (rows[column] for column in columns)
    axes.errorbar(rows["width"], value, [value - low, high - value], capsize=3, **look)
    for row in rows.assign(value=value).itertuples():
        face = "none" if row.learned == "False" else look["color"]
        (point,) = axes.plot(row.width, row.value, "o", color=look["color"], markerfacecolor=face)
        add_tooltip(
            point, f"{row.scene}, {row.method}: {short(row.value)} ({columns[0].replace('_', ' ')})"
        )

"""Squared errors of screen-space networks over training frames, with power laws."""

from collections.abc import Sequence
from itertools import cycle
from pathlib import Path
from typing import Literal

from pydantic import Field

from neural_shadows.evaluation.look import COLOURS
from neural_shadows.metrics.registry import metrics
from neural_shadows.reports.data.table import read_table
from neural_shadows.reports.drawing import style
from neural_shadows.reports.drawing.curves import (
    MARKERS,
    NUMBERS,
    TEXTS,
    Look,
    draw_legend,
    draw_panel,
    height_of,
)
from neural_shadows.reports.drawing.style import Figure
from neural_shadows.reports.tables import frame_curves
from neural_shadows.sections.table_figures import RowsFigure
from neural_shadows.settings.records import Row


class Settings(RowsFigure):
    """Squared errors over training frames, with predictions."""

    tables = (frame_curves.Settings,)
    kind: Literal["frame_curves"] = Field(description="`frame_curves`")


def draw(table_csv: Path, rows: Sequence[Row], heading: str) -> Figure:
    """Draw the learning curves of a frame set.

    Args:
        rows: of the table, all of one frame set.
    """
    table, looks = read_table(table_csv, TEXTS, (*NUMBERS, "base")), looks_of(rows)
    table = table[(table["scene"] == rows[0]["scene"]) & table["method"].isin([*looks])]
    figure = style.new_figure(heading, 11, 7)
    axes, metric = figure.subplots(), table["metric"].iloc[0]
    draw_panel(axes, metric, table, looks, "base", "frames")
    # Ten times the base's and more: a line would press the curves together.
    far = height_of(metric, table["no_shadow"].max())
    axes.set_title(f"{metrics()[metric].heading} (no shadow: {far:,.0f})")
    draw_legend(figure, table, looks, "the network's base, or the light map", columns=2)
    return figure


def looks_of(rows: Sequence[Row]) -> dict[str, Look]:
    """Looks by label: a colour a network, a marker a number of steps."""
    colours = dict(zip(dict.fromkeys(row["experiment"] for row in rows), cycle(COLOURS)))
    markers = dict(zip(sorted({row["steps"] for row in rows}), cycle(MARKERS)))
    return {row["label"]: (colours[row["experiment"]], markers[row["steps"]]) for row in rows}

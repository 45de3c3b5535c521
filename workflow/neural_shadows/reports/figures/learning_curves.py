"""Loss and quality over training samples, with power laws."""

from collections.abc import Mapping, Sequence
from itertools import cycle
from pathlib import Path
from typing import Literal

import pandas as pd
from pydantic import Field

from neural_shadows.evaluation.look import COLOURS
from neural_shadows.reports.data.table import read_table
from neural_shadows.reports.drawing import style
from neural_shadows.reports.drawing.curves import (
    MARKERS,
    NUMBERS,
    TEXTS,
    Look,
    draw_legend,
    draw_panel,
)
from neural_shadows.reports.drawing.style import Figure
from neural_shadows.reports.tables import learning_curves
from neural_shadows.sections.table_figures import RowsFigure
from neural_shadows.settings.records import Row


class Settings(RowsFigure):
    """Loss and quality over training samples, with predictions."""

    tables = (learning_curves.Settings,)
    kind: Literal["learning_curves"] = Field(description="`learning_curves`")


def draw(table_csv: Path, rows: Sequence[Row], heading: str) -> Figure:
    """Draw the learning curves of a scene.

    Args:
        rows: of the table, all of one scene.
    """
    curves = read_table(table_csv, TEXTS, NUMBERS)
    curves = curves[curves["scene"] == rows[0]["scene"]]
    looks = {row["label"]: (colour, MARKERS[0]) for row, colour in zip(rows, cycle(COLOURS))}
    return curves_figure(curves, looks, title=heading)


def curves_figure(table: pd.DataFrame, looks: Mapping[str, Look], *, title: str) -> Figure:
    """Draw a panel a metric.

    Args:
        table: of `curve_table`, of one scene.
        looks: the methods, in the legend's order.
    """
    table = table[table["method"].isin([*looks])]
    figure = style.new_figure(title, 11, 8.2)
    for axes, (metric, panel) in zip(
        figure.subplots(2, 2).flat, table.groupby("metric", sort=False)
    ):
        draw_panel(axes, metric, panel, looks, "no_shadow", "samples")
        if metric == "lpips" and panel["thesis"].notna().any():
            axes.set_title("LPIPS ↓ (the thesis's may be of another network)")
    draw_legend(figure, table, looks, "no shadow", columns=3)
    return figure

"""Sensitivity to each feature [Datta et al. 2022, figure 3]."""

from pathlib import Path
from typing import TYPE_CHECKING, ClassVar, Literal

import pandas as pd
from pydantic import Field

from neural_shadows.evaluation.look import BLUE
from neural_shadows.reports.data.screen_rows import learned_rows
from neural_shadows.reports.drawing import figure_inputs
from neural_shadows.reports.drawing.chart import add_tooltip, write_chart
from neural_shadows.reports.drawing.style import GRID, new_figure, note_below
from neural_shadows.reports.tables import screen_features
from neural_shadows.reports.tables.screen_features import LEAST_SHARE
from neural_shadows.running.stage import run_stage
from neural_shadows.sections.any_report import Chapter
from neural_shadows.sections.table_figures import TableFigure
from neural_shadows.settings.records import Run

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SHARE = "share_"


class Settings(TableFigure):
    """Sensitivity of screen-space networks to their features."""

    tables = (screen_features.Settings,)
    chapter: ClassVar[Chapter] = "soft"

    kind: Literal["screen_sensitivity"] = Field(description="`screen_sensitivity`")


files = figure_inputs.table_csv
params = figure_inputs.run


def draw(table: Path, png: Path, svg: Path, *, title: str, run: Run) -> None:
    """Draw the CSV of a table of `screen_features`."""
    rows = learned_rows(pd.read_csv(table, dtype={"label": str})).set_index("label")
    write_chart(sensitivity_figure(rows, f"{title} ({run['scale']} scale)"), png, svg)


def sensitivity_figure(table: pd.DataFrame, title: str) -> "Figure":
    """Draw a panel a network, a bar a feature."""
    figure = new_figure(title, 10, 0.9 + 0.26 * (table.filter(like=SHARE).notna().sum().sum() + 9))
    columns = [name for name in table if name.startswith(SHARE)]
    counts = [max(2, int(table.loc[label, columns].notna().sum())) for label in table.index]
    grid = figure.subplots(len(table), 1, sharex=True, squeeze=False, height_ratios=counts)
    for axes, label in zip(grid[:, 0], table.index):
        shares = 100 * table.loc[label, columns].astype(float).dropna().sort_values()
        names = [name.removeprefix(SHARE) for name in shares.index]
        for name, bar in zip(names, axes.barh(names, shares, color=BLUE)):
            add_tooltip(bar, f"{label}, {name}: {bar.get_width():.1f} %")
        axes.axvline(100 * LEAST_SHARE, color="#555555", linestyle="--", linewidth=1)
        axes.set_title(label, loc="left", fontsize=10)
        axes.grid(axis="x", **GRID)
        axes.set_axisbelow(True)
    grid[-1, 0].set_xlabel("share of the sensitivities of all features, %")
    note_below(
        figure,
        f"Dashed: {100 * LEAST_SHARE:g} %, the paper's threshold for features. Sensitivity: the change "
        "of the output\nwith noise of a tenth of a feature's standard deviation.",
    )
    return figure


if "snakemake" in globals():
    run_stage(snakemake, draw)

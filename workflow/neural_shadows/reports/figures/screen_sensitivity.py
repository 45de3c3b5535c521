"""Sensitivity to each feature [Datta et al. 2022, figure 3]."""

from pathlib import Path
from typing import Literal

import pandas as pd
from pydantic import Field

from neural_shadows.evaluation.look import BLUE
from neural_shadows.reports.data.soft_frames import learned_rows
from neural_shadows.reports.drawing.chart import add_tooltip
from neural_shadows.reports.drawing.style import GRID, Figure, new_figure, note_below
from neural_shadows.reports.tables import screen_features
from neural_shadows.reports.tables.screen_features import LEAST_SHARE
from neural_shadows.sections.table_figures import TableFigure

SHARE = "share_"
# Symbols are the papers' (`frames.features`): cosines are of the normal with a direction.
MEANINGS = {
    "c_e": "cosine to the light, and its size",
    "view": "cosine to the eye over depth",
    "ratio": "map's depth over distance from the light",
    "difference": "map's depth less distance from the light",
    "agreement": "cosine between point's and map's normals",
    "d": "depth along the camera's axis",
    "n": "normal",
    "z": "map's depth",
    "n_e": "map's normal",
    "z_f": "distance from the light",
    "c_c": "cosine to the eye",
    "cosine": "cosine to the light",
    "c_v_by_d": "cosine to the eye over distance from it",
    "penumbra": "width of the penumbra in the frame",
    "penumbra_pcss": "the same without regard to slant",
    "behind": "distance behind the blocker",
    "z_b_by_z": "blocker's distance from the light over the point's",
    "z_b": "blocker's distance from the light",
    "r_e": "radius of the light",
    "base_hard": "shadow by one texel of the map",
    "base_pcf": "shadow by 2 × 2 texels of the map",
    "base_msm": "shadow by moments of the map",
}


class Settings(TableFigure):
    """Sensitivity of screen-space networks to their features."""

    tables = (screen_features.Settings,)
    kind: Literal["screen_sensitivity"] = Field(description="`screen_sensitivity`")


def draw(table_csv: Path, heading: str) -> Figure:
    """Draw the CSV of a table of `screen_features`."""
    rows = learned_rows(pd.read_csv(table_csv, dtype={"label": str})).set_index("label")
    return sensitivity_figure(rows, heading)


def sensitivity_figure(table: pd.DataFrame, title: str) -> Figure:
    """Draw a panel a network, a bar a feature."""
    figure = new_figure(title, 10, 0.9 + 0.26 * (table.filter(like=SHARE).notna().sum().sum() + 9))
    columns = [name for name in table if name.startswith(SHARE)]
    counts = [max(2, int(table.loc[label, columns].notna().sum())) for label in table.index]
    grid = figure.subplots(len(table), 1, sharex=True, squeeze=False, height_ratios=counts)
    for axes, label in zip(grid[:, 0], table.index):
        shares = 100 * table.loc[label, columns].astype(float).dropna().sort_values()
        keys = [name.removeprefix(SHARE) for name in shares.index]
        names = [f"{MEANINGS[key]} ({key})" if key in MEANINGS else key for key in keys]
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

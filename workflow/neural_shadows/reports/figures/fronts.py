"""Quality over what it costs: bytes, frame time, training time [5.4.1]."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from neural_shadows.evaluation.method_names import RAY_TRACED, is_shadow_map
from neural_shadows.files.broken import broken
from neural_shadows.reports.figures.style import COLOURS, DPI, write_strip
from neural_shadows.reports.tables.writing import read_table

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COSTS = {
    "bytes": ("size, KiB", 1 / 1024),
    "frame_ms": ("frame time, ms", 1),
    "training_seconds": ("training, s", 1),
}
# A kind of method: its colour and marker.
STYLES = {
    "shadow map": ("#777777", "s"),
    "ray traced": ("#000000", "*"),
    "frequency": (COLOURS[1], "o"),
    "ray_grid": (COLOURS[3], "v"),
    "occupancy_ray_grid": (COLOURS[2], "^"),
    "hash_grid": (COLOURS[4], "D"),
    "occupancy_field": (COLOURS[0], "P"),
}
OTHER = (COLOURS[5], "X")
UNNAMED = {"frequency": "thesis's network"}


def front(cost: np.ndarray, error: np.ndarray) -> np.ndarray:
    """Indices of the points that no other undercuts in both, by rising cost."""
    order = np.lexsort((error, cost))
    best = np.minimum.accumulate(error[order])
    return order[np.r_[True, best[1:] < best[:-1]]]


def fronts_figure(table: pd.DataFrame, kinds: Sequence[str], quality: str, *, title: str) -> Figure:
    """Draw a scene's methods, a panel for each cost.

    Args:
        table: rows of `networks_table` of one scene.
        kinds: of each row, as `kind_of` gives them.
        quality: `lpips`, or `flip` where there is no LPIPS.
    """
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

    figure = Figure(figsize=(14, 5.2), dpi=DPI, layout="constrained")
    panels = figure.subplots(1, 3, sharey=True)
    for axes, (column, (label, factor)) in zip(panels, COSTS.items()):
        _panel(axes, table, kinds, quality, column, factor)
        axes.set_xlabel(label)
    panels[0].set_ylabel(f"{quality.upper()}, mean [95 % interval]")
    shown = sorted(set(kinds), key=lambda kind: [*STYLES, kind].index(kind))
    figure.legend(
        handles=[
            Line2D(
                [],
                [],
                color=STYLES.get(kind, OTHER)[0],
                marker=STYLES.get(kind, OTHER)[1],
                linestyle="",
                label=UNNAMED.get(kind, kind.replace("_", " ")),
            )
            for kind in shown
        ],
        loc="outside lower center",
        ncols=len(shown),
    )
    figure.suptitle(title, x=0.01, ha="left", weight="bold")
    return figure


def _panel(
    axes: Axes,
    table: pd.DataFrame,
    kinds: Sequence[str],
    quality: str,
    column: str,
    factor: float,
) -> None:
    from matplotlib.ticker import LogLocator, NullFormatter

    cost = table[column].to_numpy(float) * factor
    error = table[quality].to_numpy(float)
    # Of the whole table, so that all panels share their heights.
    floor = np.nanmin(table[f"{quality}_low"]) / 2
    known = np.isfinite(cost) & np.isfinite(error)
    for i in np.flatnonzero(known):
        colour, marker = STYLES.get(kinds[i], OTHER)
        spread = [[error[i] - table[f"{quality}_low"].iloc[i]]]
        spread.append([table[f"{quality}_high"].iloc[i] - error[i]])
        axes.errorbar(cost[i], error[i], spread, color=colour, marker=marker, capsize=2)
    if column == "training_seconds":
        # A map trains nothing: a line that a network must come below.
        for i in np.flatnonzero(np.isfinite(error)):
            if kinds[i] == "shadow map":
                axes.axhline(error[i], color="#777777", linewidth=0.7, linestyle=":")
                text = table["method"].iloc[i]
                axes.annotate(
                    text, (0.01, error[i]), xycoords=("axes fraction", "data"), fontsize=7
                )
    for i in np.flatnonzero(np.isfinite(cost) & np.isnan(error)):
        # Ray tracing is the reference: no error, below any height of a logarithmic axis.
        colour, marker = STYLES.get(kinds[i], OTHER)
        axes.plot(cost[i], floor, color=colour, marker=marker, markersize=11, clip_on=False)
        axes.annotate(
            "ray traced: 0",
            (cost[i], floor),
            fontsize=7,
            xytext=(8, -2),
            textcoords="offset points",
        )
    indices = np.flatnonzero(known)
    best = indices[front(cost[indices], error[indices])]
    axes.plot(cost[best], error[best], color="#bbbbbb", linewidth=1, zorder=0)
    for i in best:
        axes.annotate(
            table["method"].iloc[i],
            (cost[i], error[i]),
            fontsize=7,
            xytext=(5, 4),
            textcoords="offset points",
        )
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.grid(linewidth=0.4, alpha=0.4)
    # Less than a decade has no power of ten to label.
    axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axes.xaxis.set_major_formatter("{x:g}")
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.tick_params(axis="x", labelsize="small")
    if column == "training_seconds":
        axes.set_xlim(left=axes.get_xlim()[0] / 2.5)  # room for the maps' names


def kind_of(method: str, encoding: str) -> str:
    """What a method with this key is: a map, ray traced, or a network of this encoding."""
    if method == RAY_TRACED:
        return "ray traced"
    return "shadow map" if is_shadow_map(method) else encoding


def read_networks(table_csv: Path, scene: str, labels: Sequence[str]) -> pd.DataFrame:
    """The rows with these labels, of a scene of a table of `write_networks_table`.

    Raises:
        InputError: the table is missing, not whole, or without one of the rows.
    """
    qualities = [metric + end for metric in ("lpips", "flip") for end in ("", "_low", "_high")]
    table = read_table(table_csv, ("scene", "method", "encoding"), (*qualities, *COSTS))
    table = table[table["scene"] == scene].set_index("method", drop=False)
    for label in labels:
        if label not in table.index:
            raise broken(table_csv, f"has no row {label!r} of {scene}")
    return table.loc[labels]


def write_fronts_figure(
    table_csv: Path,
    png: Path,
    svg: Path,
    *,
    title: str,
    scene: str,
    rows: Sequence[Mapping[str, str | None]],
    scale: str,
) -> None:
    """Draw the figure of a scene of a table of networks.

    Args:
        table_csv: as `write_networks_table` wrote it.
        rows: the table's rows of that scene: `method` and `label`.

    Raises:
        InputError: the table is not whole.
    """
    table = read_networks(table_csv, scene, [row["label"] for row in rows])
    kinds = [kind_of(row["method"], table.loc[row["label"], "encoding"]) for row in rows]
    quality = "lpips" if table["lpips"].notna().any() else "flip"
    figure = fronts_figure(table, kinds, quality, title=f"{title} ({scale} scale)")
    write_strip(figure, png, svg)

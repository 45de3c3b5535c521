"""Quality over what it costs: bytes, frame time, training time [5.4.1]."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from neural_shadows.evaluation.method_names import RAY_TRACED
from neural_shadows.reports.figures import style
from neural_shadows.reports.tables.quality import with_ends
from neural_shadows.reports.tables.writing import read_table
from neural_shadows.running.stage import run_stage

COSTS = {
    "bytes": ("size, KiB", 1 / 1024),
    "frame_ms": ("frame time, ms", 1),
    "training_seconds": ("training, s", 1),
}
# A kind of method: its colour and marker, in the legend's order.
STYLES = {
    "shadow map": ("#777777", "s"),
    "ray traced": ("#000000", "*"),
    "thesis's network": (style.COLOURS[1], "o"),
    "ray grid": (style.COLOURS[3], "v"),
    "occupancy ray grid": (style.COLOURS[2], "^"),
    "hash grid": (style.COLOURS[4], "D"),
    "occupancy field": (style.COLOURS[0], "P"),
}
OTHER = (style.COLOURS[5], "X")


def draw(
    table: Path,
    png: Path,
    svg: Path,
    *,
    title: str,
    scene: str,
    rows: Sequence[style.Section],
    run: style.Section,
) -> None:
    """Draw a scene of a table of networks.

    Args:
        table: its CSV.
        rows: the table's rows of that scene.

    Raises:
        InputError: the table is missing or not whole.
    """
    numbers = (*with_ends("lpips"), *with_ends("flip"), *COSTS)
    networks = read_table(table, ("scene", "method", "encoding"), numbers)
    networks = networks[networks["scene"] == scene].set_index("method", drop=False)
    networks = networks.loc[[row["label"] for row in rows]]
    keys = [row["method"] for row in rows]
    kinds = [kind_of(key, encoding) for key, encoding in zip(keys, networks["encoding"])]
    figure = pareto_figure(networks.assign(kind=kinds), title=f"{title} ({run['scale']} scale)")
    style.write_figure(figure, png, svg)


def kind_of(method: str, encoding: str | float) -> str:
    """What the legend calls a method with this key, whose encoding is NaN if it is no network."""
    if not isinstance(encoding, str):
        return "ray traced" if method == RAY_TRACED else "shadow map"
    return "thesis's network" if encoding == "frequency" else encoding.replace("_", " ")


def front(cost: np.ndarray, error: np.ndarray) -> np.ndarray:
    """Indices of the points that no other undercuts in both, by rising cost."""
    order = np.lexsort((error, cost))
    best = np.minimum.accumulate(error[order])
    return order[np.r_[True, best[1:] < best[:-1]]]


def pareto_figure(table: pd.DataFrame, *, title: str) -> Figure:
    """Draw a scene's methods, a panel for each cost; FLIP where there is no LPIPS.

    Args:
        table: rows of a table of networks of one scene, with their `kind` as of `kind_of`.
    """
    quality = "lpips" if table["lpips"].notna().any() else "flip"
    points = table.rename(columns=dict(zip(with_ends(quality), ("error", "low", "high"))))
    # Ray tracing is the reference: its error 0 is below any height of the axis.
    exact, floor = points["error"].isna(), points["low"].min() / 2
    points.loc[exact, ["error", "low", "high"]] = floor
    figure = style.new_figure(title, 14, 5.2)
    panels = figure.subplots(1, 3, sharey=True)
    for axes, (column, (label, factor)) in zip(panels, COSTS.items()):
        axes.set(xscale="log", yscale="log", xlabel=label)
        shown = points.assign(cost=points[column] * factor)
        for row in shown.dropna(subset="cost").itertuples():
            colour, marker = STYLES.get(row.kind, OTHER)
            spread = [[row.error - row.low], [row.high - row.error]]
            look = {"color": colour, "marker": marker, "label": row.kind, "linestyle": ""}
            axes.errorbar(row.cost, row.error, spread, markersize=7, capsize=2, **look)
        for cost in shown["cost"][exact].dropna():
            axes.text(1.1 * cost, floor, "ray traced: 0", va="center", fontsize=7)
        if column == "training_seconds":  # maps train nothing: a network must come below their line
            axes.set_xlim(left=axes.get_xlim()[0] / 2.5)  # room for the maps' names
            for row in shown[shown["kind"] == "shadow map"].itertuples():
                axes.axhline(row.error, color=STYLES[row.kind][0], linewidth=0.7, linestyle=":")
                axes.text(
                    0.01, row.error, row.method, transform=axes.get_yaxis_transform(), fontsize=7
                )
        _draw_front(axes, shown[~exact].dropna(subset="cost"))
        axes.grid(**style.GRID)
        style.plain_numbers(axes.xaxis)
        axes.tick_params(axis="x", labelsize="small")
    panels[0].set_ylabel(f"{quality.upper()}, mean [95 % interval]")
    style.plain_numbers(panels[0].yaxis)
    style.legend_below(figure)
    return figure


def _draw_front(axes: Axes, points: pd.DataFrame) -> None:
    """Join and name the methods that no other undercuts, the names within the panel."""
    best = points.iloc[front(points["cost"].to_numpy(), points["error"].to_numpy())]
    axes.plot(best["cost"], best["error"], color="#bbbbbb", linewidth=1, zorder=0)
    axes.autoscale_view()
    places = (axes.transData - axes.transAxes).transform(best[["cost", "error"]])
    for i, row in enumerate(best.itertuples()):
        # Below and to the left in the right half; below also where the last name is too near.
        left = places[i, 0] > 0.5
        below = left or (i > 0 and places[i - 1, 1] - places[i, 1] < 0.04)
        look = {"ha": "right" if left else "left", "va": "top" if below else "bottom"}
        offset = (-6 if left else 6, -5 if below else 5)
        look |= {"xytext": offset, "textcoords": "offset points", "fontsize": 7}
        axes.annotate(row.method, (row.cost, row.error), **look)


if "snakemake" in globals():
    run_stage(snakemake, draw)

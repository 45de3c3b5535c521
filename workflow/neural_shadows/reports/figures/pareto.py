"""Quality over what it costs: bytes, frame time, training time [5.4.1]."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from neural_shadows.evaluation.method_names import RAY_TRACED, is_shadow_map
from neural_shadows.reports.figures import style
from neural_shadows.reports.tables.quality import with_ends
from neural_shadows.reports.tables.writing import read_table
from neural_shadows.running.stage import run_stage

COSTS = {
    "bytes": ("size, KiB", 1 / 1024),
    "frame_ms": ("frame time, ms", 1),
    "training_seconds": ("training, s", 1),
}
MAP_COLOUR, FRONT_COLOUR = "#777777", "#bbbbbb"
# A kind of method: its colour and marker.
STYLES = {
    "shadow map": (MAP_COLOUR, "s"),
    "ray traced": ("#000000", "*"),
    "frequency": (style.COLOURS[1], "o"),
    "ray_grid": (style.COLOURS[3], "v"),
    "occupancy_ray_grid": (style.COLOURS[2], "^"),
    "hash_grid": (style.COLOURS[4], "D"),
    "occupancy_field": (style.COLOURS[0], "P"),
}
OTHER = (style.COLOURS[5], "X")
UNNAMED = {"frequency": "thesis's network"}


def draw(
    table: Path,
    png: Path,
    svg: Path,
    *,
    title: str,
    scene: str,
    rows: Sequence[Mapping[str, Any]],
    run: Mapping[str, Any],
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


def kind_of(method: str, encoding: str) -> str:
    """What a method with this key is: a map, ray traced, or a network of this encoding."""
    if method == RAY_TRACED:
        return "ray traced"
    return "shadow map" if is_shadow_map(method) else encoding


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
    figure = style.new_figure(title, 14, 5.2)
    panels = figure.subplots(1, 3, sharey=True)
    for axes, (column, (label, factor)) in zip(panels, COSTS.items()):
        shown = points.assign(cost=points[column] * factor)
        axes.set(xscale="log", yscale="log", xlabel=label)
        measured = shown.dropna(subset=["cost", "error"])
        for row in measured.itertuples():
            colour, marker = STYLES.get(row.kind, OTHER)
            spread = [[row.error - row.low], [row.high - row.error]]
            axes.errorbar(row.cost, row.error, spread, color=colour, marker=marker, capsize=2)
        if column == "training_seconds":
            axes.set_xlim(left=axes.get_xlim()[0] / 2.5)  # room for the maps' names
            _draw_untrained(axes, shown[shown["kind"] == "shadow map"])
        _draw_exact(axes, shown)
        _draw_front(axes, measured)
        axes.grid(**style.GRID)
        style.plain_numbers(axes.xaxis)
        axes.tick_params(axis="x", labelsize="small")
    panels[0].set_ylabel(f"{quality.upper()}, mean [95 % interval]")
    style.plain_numbers(panels[0].yaxis)
    entries = []
    for kind in sorted(set(table["kind"]), key=[*STYLES, *table["kind"]].index):
        colour, marker = STYLES.get(kind, OTHER)
        text = UNNAMED.get(kind, kind.replace("_", " "))
        entries.append(Line2D([], [], color=colour, marker=marker, linestyle="", label=text))
    style.legend_below(figure, entries)
    return figure


def _draw_front(axes: Axes, points: pd.DataFrame) -> None:
    """Join and name the methods that no other undercuts, the names within the panel."""
    best = points.iloc[front(points["cost"].to_numpy(), points["error"].to_numpy())]
    axes.plot(best["cost"], best["error"], color=FRONT_COLOUR, linewidth=1, zorder=0)
    axes.autoscale_view()
    places = axes.transData.transform(best[["cost", "error"]])
    places = axes.transAxes.inverted().transform(places)
    for i, row in enumerate(best.itertuples()):
        # Below and to the left in the right half; below also where the last name is too near.
        left = places[i, 0] > 0.5
        below = left or (i > 0 and places[i - 1, 1] - places[i, 1] < 0.04)
        look = {"ha": "right" if left else "left", "va": "top" if below else "bottom"}
        offset = (-6 if left else 6, -5 if below else 5)
        _name(axes, row.method, (row.cost, row.error), offset, **look)


def _draw_untrained(axes: Axes, maps: pd.DataFrame) -> None:
    """Draw maps, which train nothing, as lines that a network must come below."""
    for row in maps.dropna(subset="error").itertuples():
        axes.axhline(row.error, color=MAP_COLOUR, linewidth=0.7, linestyle=":")
        _name(axes, row.method, (0.01, row.error), (0, 0), xycoords=("axes fraction", "data"))


def _draw_exact(axes: Axes, points: pd.DataFrame) -> None:
    """Draw ray tracing, the reference, whose error 0 is below any height of the axis."""
    floor = points["low"].min() / 2  # of the whole table, so that all panels share their heights
    for row in points[points["error"].isna()].dropna(subset="cost").itertuples():
        colour, marker = STYLES.get(row.kind, OTHER)
        axes.plot(row.cost, floor, color=colour, marker=marker, markersize=11, clip_on=False)
        _name(axes, "ray traced: 0", (row.cost, floor), (8, -2))


def _name(axes: Axes, text: str, at: tuple[float, float], offset: tuple[int, int], **look) -> None:
    axes.annotate(text, at, fontsize=7, xytext=offset, textcoords="offset points", **look)


if "snakemake" in globals():
    run_stage(snakemake, draw)

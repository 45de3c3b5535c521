"""Quality over what it costs: bytes in a file and in memory, time, building [5.4.1]."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from neural_shadows.evaluation.method_names import NO_SHADOW, RAY_TRACED, is_null
from neural_shadows.reports.figures import style
from neural_shadows.reports.published import NETWORKS
from neural_shadows.reports.tables.quality import with_ends
from neural_shadows.reports.tables.writing import read_table
from neural_shadows.running.stage import run_stage

COSTS = {
    "stored_bytes": ("stored, KiB", 1 / 1024),
    "resident_bytes": ("resident, KiB", 1 / 1024),
    "own_ms": ("own time a frame, ms", 1),
    "build_seconds": ("from mesh file to network, s", 1),
}
# A kind of method: its colour and marker, in the legend's order. Rivals that train nothing have
# the colours of dark text, networks bright ones.
STYLES = {
    "shadow map": ("#777777", "s"),
    "filtered or 16-bit shadow map": ("#aaaaaa", "d"),
    "ray traced": ("#000000", "*"),
    "mesh": ("#000000", "h"),
    "distances, untrained": ("#8c564b", "P"),
    "voxel dag": ("#8c564b", "<"),
    "height map": ("#8c564b", ">"),
    "thesis's network": (style.COLOURS[1], "o"),
    "ray grid": (style.COLOURS[3], "v"),
    "occupancy ray grid": (style.COLOURS[2], "^"),
    "hash grid": (style.COLOURS[4], "D"),
    "occupancy field": (style.COLOURS[0], "P"),
}
OTHER = (style.COLOURS[5], "X")
LINES = {"no shadow": ":", "as printed": "--"}  # what has a quality and no cost here
NOT_SHOWN = "all dark"
PRINTED_NOTES = {True: " (of another LPIPS network)", False: " (mean, not pooled)"}


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
    numbers = (*with_ends("lpips"), *with_ends("flip"), "psnr", *with_ends("psnr_pooled"))
    texts = ("scene", "method", "encoding", "learned")
    found = read_table(table, texts, (*numbers, *COSTS, "samples"))
    found = found[found["scene"] == scene].set_index("method", drop=False)
    networks = found.loc[[row["label"] for row in rows]]
    keys = [row["method"] for row in rows]
    kinds = map(kind_of, keys, networks["encoding"], networks["samples"])
    printed = found[found["method"].isin(NETWORKS.values())]
    networks = pd.concat([networks.assign(kind=[*kinds]), printed.assign(kind="as printed")])
    figure = pareto_figure(networks, title=f"{title} ({run['scale']} scale)")
    style.write_figure(figure, png, svg)


def kind_of(method: str, encoding: str | float, samples: float) -> str:
    """What the legend calls a method with this key.

    `encoding` is NaN if it is no network, `samples` 0 of one that is built without training.
    """
    if not isinstance(encoding, str):
        if is_null(method):
            return "no shadow" if method == NO_SHADOW else NOT_SHOWN
        plain = method.removeprefix("shadow_map_").isdecimal()
        kind = "shadow map" if plain else "filtered or 16-bit shadow map"
        return "ray traced" if method == RAY_TRACED else kind
    if encoding == "occupancy_field" and samples == 0:
        return "distances, untrained"
    return "thesis's network" if encoding == "frequency" else encoding.replace("_", " ")


def front(cost: np.ndarray, error: np.ndarray) -> np.ndarray:
    """Indices of the points that no other undercuts in both, by rising cost."""
    order = np.lexsort((error, cost))
    best = np.minimum.accumulate(error[order])
    return order[np.r_[True, best[1:] < best[:-1]]]


def pareto_figure(table: pd.DataFrame, *, title: str) -> Figure:
    """Draw a scene's methods, a column of panels for each cost.

    Above LPIPS, or FLIP where there is none; below pooled PSNR, upwards better. Networks that have
    not learned are hollow. What costs nothing there, and what the thesis prints, is a line.

    Args:
        table: rows of a table of networks of one scene, with their `kind` as of `kind_of`, or
            `as printed` of the thesis's own values.
    """
    measured = table["lpips_low"].notna().any()  # what is printed has no interval
    perceived = "lpips" if measured else "flip"
    # The thesis prints a mean PSNR, and no views to pool.
    table = table.assign(psnr_pooled=table["psnr_pooled"].fillna(table["psnr"]))
    figure = style.new_figure(title, 17, 9.6)
    panels = figure.subplots(2, len(COSTS), sharex="col", sharey="row")
    for row, metric in zip(panels, (perceived, "psnr_pooled")):
        points = table.rename(columns=dict(zip(with_ends(metric), ("value", "low", "high"))))
        for axes, (column, (label, factor)) in zip(row, COSTS.items()):
            axes.set(xscale="log", yscale="log" if metric == perceived else "linear")
            _draw_panel(axes, points.assign(cost=points[column] * factor), metric == perceived)
            axes.grid(**style.GRID)
            style.plain_numbers(axes.xaxis)
            axes.tick_params(axis="x", labelsize="x-small")
            if metric != perceived:
                axes.set_xlabel(label)
    panels[0, 0].set_ylabel(f"{perceived.upper()}, mean [95 % interval]")
    panels[1, 0].set_ylabel("pooled PSNR, dB [95 % interval]")
    style.plain_numbers(panels[0, 0].yaxis)
    drawn = [kind for kind in table["kind"] if kind not in (*LINES, "ray traced", NOT_SHOWN)]
    kinds = [kind for kind in dict.fromkeys([*STYLES, *drawn]) if kind in drawn]
    entries = [Line2D([], [], label=kind, **_look(kind)) for kind in kinds]
    style.legend_below(figure, entries + style.hollow(table))
    return figure


def _look(kind: str) -> dict[str, Any]:
    colour, marker = STYLES.get(kind, OTHER)
    return {"color": colour, "marker": marker, "linestyle": "", "markersize": 7}


def _draw_panel(axes: Axes, points: pd.DataFrame, lower_is_better: bool) -> None:
    """The methods at their costs, and lines of what has a quality but no cost here."""
    methods = points[~points["kind"].isin([*LINES, "ray traced", NOT_SHOWN])]
    measured = methods.dropna(subset="cost")
    for row in measured.itertuples():
        spread = [[row.value - row.low], [row.high - row.value]]
        look = _look(row.kind) | ({"markerfacecolor": "none"} if row.learned == "False" else {})
        axes.errorbar(row.cost, row.value, spread, capsize=2, **look)
    lines = points[points["kind"].isin(LINES)]
    if measured["kind"].ne("shadow map").all():  # maps are rendered anew in each frame
        lines = pd.concat([lines, methods[methods["kind"] == "shadow map"]])
    if len(lines) > 2:
        axes.set_xlim(left=axes.get_xlim()[0] / 4)  # room for their names
    for row in lines.itertuples():
        look = {"color": "#666666", "linewidth": 0.7, "linestyle": LINES.get(row.kind, "-.")}
        axes.axhline(row.value, zorder=0, **look)
        place = axes.get_yaxis_transform()
        name = row.method + PRINTED_NOTES[lower_is_better] * (row.kind == "as printed")
        axes.text(0.01, row.value, name, transform=place, va="bottom", fontsize=7)
    for cost in points["cost"][points["kind"] == "ray traced"].dropna():
        axes.axvline(cost, color=STYLES["ray traced"][0], linewidth=0.7, zorder=0)
        place = axes.get_xaxis_transform()
        axes.text(cost, 0.02, " ray traced: exact", transform=place, rotation=90, fontsize=7)
    _draw_front(axes, measured, lower_is_better)


def _draw_front(axes: Axes, points: pd.DataFrame, lower_is_better: bool) -> None:
    """Join and name the methods that no other betters in both, the names within the panel."""
    error = points["value"].to_numpy() * (1 if lower_is_better else -1)
    best = points.iloc[front(points["cost"].to_numpy(), error)] if len(points) else points
    axes.plot(best["cost"], best["value"], color="#bbbbbb", linewidth=1, zorder=0)
    axes.autoscale_view()
    places = (axes.transData - axes.transAxes).transform(best[["cost", "value"]])
    away = -1 if lower_is_better else 1  # the side of the front where nothing is: better
    lines = 0
    for i, row in enumerate(best.itertuples()):
        left = places[i, 0] > 0.5
        # A line further than the last name where that is too near.
        lines = lines + 1 if i and np.abs(places[i] - places[i - 1]).max() < 0.06 else 0
        look = {"ha": "right" if left else "left", "va": "center"}
        look |= {"xytext": (-6 if left else 6, away * (8 + 9 * lines))}
        look |= {"textcoords": "offset points", "fontsize": 7}
        axes.annotate(row.method, (row.cost, row.value), **look)


if "snakemake" in globals():
    run_stage(snakemake, draw)

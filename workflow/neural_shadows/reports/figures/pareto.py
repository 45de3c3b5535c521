"""Quality over what it costs: bytes, frame time, training time [5.4.1]."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator, NullFormatter

from neural_shadows.errors import InputError
from neural_shadows.evaluation.method_names import RAY_TRACED, is_shadow_map
from neural_shadows.reports.figures.style import COLOURS, GRID, new_figure, write_figure
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
    "frequency": (COLOURS[1], "o"),
    "ray_grid": (COLOURS[3], "v"),
    "occupancy_ray_grid": (COLOURS[2], "^"),
    "hash_grid": (COLOURS[4], "D"),
    "occupancy_field": (COLOURS[0], "P"),
}
OTHER = (COLOURS[5], "X")
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
        InputError: the table is missing, not whole, or without one of the rows.
    """
    networks = read_networks(table, scene, [row["label"] for row in rows])
    encodings = networks["encoding"]
    kinds = [kind_of(row["method"], encodings[row["label"]]) for row in rows]
    quality = "lpips" if networks["lpips"].notna().any() else "flip"
    figure = pareto_figure(networks, kinds, quality, title=f"{title} ({run['scale']} scale)")
    write_figure(figure, png, svg)


def kind_of(method: str, encoding: str) -> str:
    """What a method with this key is: a map, ray traced, or a network of this encoding."""
    if method == RAY_TRACED:
        return "ray traced"
    return "shadow map" if is_shadow_map(method) else encoding


def read_networks(table_csv: Path, scene: str, labels: Sequence[str]) -> pd.DataFrame:
    """The rows with these labels, of a scene of a table of networks, indexed by label.

    Raises:
        InputError: the table is missing, not whole, or without one of the rows.
    """
    qualities = [metric + end for metric in ("lpips", "flip") for end in ("", "_low", "_high")]
    table = read_table(table_csv, ("scene", "method", "encoding"), (*qualities, *COSTS))
    table = table[table["scene"] == scene].set_index("method", drop=False)
    if missing := [label for label in labels if label not in table.index]:
        raise InputError(f"{table_csv}: has no row {missing[0]!r} of {scene}")
    return table.loc[labels]


def front(cost: np.ndarray, error: np.ndarray) -> np.ndarray:
    """Indices of the points that no other undercuts in both, by rising cost."""
    order = np.lexsort((error, cost))
    best = np.minimum.accumulate(error[order])
    return order[np.r_[True, best[1:] < best[:-1]]]


def pareto_figure(table: pd.DataFrame, kinds: Sequence[str], quality: str, *, title: str) -> Figure:
    """Draw a scene's methods, a panel for each cost.

    Args:
        table: rows of a table of networks of one scene.
        kinds: of each row, as `kind_of` gives them.
        quality: `lpips`, or `flip` where there is no LPIPS.
    """
    figure = new_figure(title, 14, 5.2)
    panels = figure.subplots(1, 3, sharey=True)
    points = table.assign(
        error=table[quality], low=table[f"{quality}_low"], high=table[f"{quality}_high"], kind=kinds
    )
    for axes, (column, (label, factor)) in zip(panels, COSTS.items()):
        shown = points.assign(cost=points[column] * factor)
        axes.set(xscale="log", yscale="log", xlabel=label)
        if column == "training_seconds":
            _draw_untrained(axes, shown[shown["kind"] == "shadow map"])
        _draw_exact(axes, shown)
        _draw_methods(axes, shown.dropna(subset=["cost", "error"]))
        axes.grid(**GRID)
        # Less than a decade has no power of ten to label.
        axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axes.xaxis.set_major_formatter("{x:g}")
        axes.xaxis.set_minor_formatter(NullFormatter())
        axes.tick_params(axis="x", labelsize="small")
    panels[-1].set_xlim(left=panels[-1].get_xlim()[0] / 2.5)  # room for the maps' names
    panels[0].set_ylabel(f"{quality.upper()}, mean [95 % interval]")
    entries = []
    for kind in sorted(set(kinds), key=[*STYLES, *kinds].index):
        colour, marker = STYLES.get(kind, OTHER)
        text = UNNAMED.get(kind, kind.replace("_", " "))
        entries.append(Line2D([], [], color=colour, marker=marker, linestyle="", label=text))
    figure.legend(handles=entries, loc="outside lower center", ncols=len(entries))
    return figure


def _draw_methods(axes: Axes, points: pd.DataFrame) -> None:
    """Draw methods with cost and error, and join and name those that no other undercuts."""
    for _, row in points.iterrows():
        colour, marker = STYLES.get(row["kind"], OTHER)
        spread = [[row["error"] - row["low"]], [row["high"] - row["error"]]]
        axes.errorbar(row["cost"], row["error"], spread, color=colour, marker=marker, capsize=2)
    best = points.iloc[front(points["cost"].to_numpy(), points["error"].to_numpy())]
    axes.plot(best["cost"], best["error"], color=FRONT_COLOUR, linewidth=1, zorder=0)
    for _, row in best.iterrows():
        _name(axes, row["method"], (row["cost"], row["error"]), (6, 6))


def _draw_untrained(axes: Axes, maps: pd.DataFrame) -> None:
    """Draw maps, which train nothing, as lines that a network must come below."""
    for _, row in maps.dropna(subset="error").iterrows():
        axes.axhline(row["error"], color=MAP_COLOUR, linewidth=0.7, linestyle=":")
        at = {"xycoords": ("axes fraction", "data"), "fontsize": 7}
        axes.annotate(row["method"], (0.01, row["error"]), **at)


def _draw_exact(axes: Axes, points: pd.DataFrame) -> None:
    """Draw ray tracing, the reference, whose error 0 is below any height of the axis."""
    floor = points["low"].min() / 2  # of the whole table, so that all panels share their heights
    for _, row in points[points["error"].isna()].dropna(subset="cost").iterrows():
        colour, marker = STYLES.get(row["kind"], OTHER)
        style = {"color": colour, "marker": marker, "markersize": 11, "clip_on": False}
        axes.plot(row["cost"], floor, **style)
        _name(axes, "ray traced: 0", (row["cost"], floor), (8, -2))


def _name(axes: Axes, text: str, at: tuple[float, float], offset: tuple[float, float]) -> None:
    axes.annotate(text, at, fontsize=7, xytext=offset, textcoords="offset points")


if "snakemake" in globals():
    run_stage(snakemake, draw)

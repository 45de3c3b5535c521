"""Quality over its costs: bytes, time and building [5.4.1]."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pandas as pd
from pydantic import Field

from neural_shadows.evaluation.look import GREY, Look
from neural_shadows.evaluation.null_predictors import NO_SHADOW
from neural_shadows.evaluation.registry import RAY_TRACED
from neural_shadows.metrics.registry import metrics as metrics_by_key
from neural_shadows.reports.data.digits import short
from neural_shadows.reports.data.method_look import LOOKS, look_of
from neural_shadows.reports.data.published import NETWORKS
from neural_shadows.reports.data.table import read_table, with_ends
from neural_shadows.reports.drawing import style
from neural_shadows.reports.drawing.chart import point_with_interval
from neural_shadows.reports.drawing.style import Axes, Figure
from neural_shadows.reports.tables import networks
from neural_shadows.sections.table_figures import RowsFigure
from neural_shadows.settings.base import Name
from neural_shadows.settings.records import Row

COSTS = {
    "stored_bytes": ("stored, KiB", 1 / 1024),
    "resident_bytes": ("resident, KiB", 1 / 1024),
    "own_ms": ("own time a frame, ms", 1),
    "build_seconds": ("from mesh file to network, s", 1),
}
PRINTED = "printed"  # the key of the thesis's own values
LINES = {NO_SHADOW: ":", PRINTED: "--"}  # methods with a quality and no cost
NOT_SHOWN = "all_dark"
PRINTED_NOTES = {True: " (of another LPIPS network)", False: " (pooled or mean)"}
EDGE = {"markeredgecolor": "black", "markeredgewidth": 1.3}
CODED = {"color": "#aaaaaa", "marker": "o", "linestyle": ""} | EDGE
FRONT = {"color": "#bbbbbb", "linewidth": 1}
MOST_IN_LINE = 2  # of the legend below a panel
PANEL = 4.75, 3.8  # inches: 342 points, so that one panel fits a phone's 375 px


class Settings(RowsFigure):
    """Quality over bytes, own time and building."""

    tables = (networks.Settings,)

    own_chapter = "costs"
    kind: Literal["pareto"] = Field(description="`pareto`")
    scene: Name = Field(description="a scene of that table")
    costs: list[Literal[tuple(COSTS)]] = Field(
        [*COSTS],
        min_length=1,
        description="costs on the horizontal axes; the first figure of `stored_bytes` alone opens "
        "the page",
    )


def draw(table_csv: Path, heading: str, costs: Sequence[str], rows: Sequence[Row]) -> Figure:
    """Draw a scene of a table of networks.

    Args:
        costs: of `COSTS`; over `stored_bytes` alone only PSNR is drawn, for the page's head.
        rows: the table's rows of that scene.
    """
    numbers = (*with_ends("lpips"), *with_ends("flip"), "psnr", *with_ends("psnr_pooled"))
    csv = read_table(table_csv, ("scene", "method", "learned", "coded"), (*numbers, *COSTS))
    csv = csv[csv["scene"] == rows[0]["scene"]].set_index("method", drop=False)
    methods = csv.loc[[row["label"] for row in rows]]
    methods = methods.assign(key=[row["method"] for row in rows], look=[*map(look_of, rows)])
    printed = csv[csv["method"].isin(NETWORKS.values())].assign(key=PRINTED, look=None)
    shown = pd.concat([methods[methods["key"] != NOT_SHOWN], printed], ignore_index=True)
    return pareto_figure(shown, costs, title=heading)


def front(cost: np.ndarray, error: np.ndarray) -> np.ndarray:
    """Indices of the Pareto-optimal points, by rising cost."""
    order = np.lexsort((error, cost))
    best = np.minimum.accumulate(error[order])
    return order[np.r_[True, best[1:] < best[:-1]][: len(order)]]


def pareto_figure(table: pd.DataFrame, costs: Sequence[str], *, title: str) -> Figure:
    """Draw a scene's methods, a row of panels a cost.

    On the left LPIPS, or FLIP where there is none; on the right pooled PSNR, upwards better.
    Unlearned networks are hollow, entropy-coded ones have a black edge. Methods without a cost and the
    thesis's printed values are lines.

    Args:
        table: rows of a table of networks of one scene, with their `key` and `look`; the key of
            the thesis's own values is `PRINTED`.
    """
    from matplotlib.lines import Line2D

    measured = table["lpips_low"].notna().any()  # printed values have no interval
    perceived = "lpips" if measured else "flip"
    # The thesis prints a mean PSNR, and no views to pool.
    table = table.assign(psnr_pooled=table["psnr_pooled"].fillna(table["psnr"]))
    metrics = ["psnr_pooled"] if [*costs] == ["stored_bytes"] else [perceived, "psnr_pooled"]
    figure = style.new_figure(title, PANEL[0] * len(metrics), 0.9 + PANEL[1] * len(costs))
    panels = figure.subplots(len(costs), len(metrics), sharex="row", sharey="col", squeeze=False)
    drawn = [*table["look"][~table["key"].isin([*LINES, RAY_TRACED])]]
    looks = dict.fromkeys([*(look for look in LOOKS.values() if look in drawn), *drawn])
    entries = [Line2D([], [], label=look.name, **_marker(look)) for look in looks]
    entries += [
        Line2D([], [], label="the best quality at each cost", **FRONT),
        *style.hollow(table),
        *([Line2D([], [], label="coded", **CODED)] if table["coded"].eq("True").any() else []),
    ]
    style.legend_below(figure, entries, MOST_IN_LINE * len(metrics))
    panel_points = []
    for row, cost in zip(panels, costs):
        for axes, metric in zip(row, metrics):
            points = table.rename(columns=dict(zip(with_ends(metric), ("value", "low", "high"))))
            points = points.assign(cost=points[cost] * COSTS[cost][1])
            axes.set(xscale="log", xlabel=COSTS[cost][0], ylabel=_heading(metric))
            axes.margins(x=0.1)
            axes.grid(**style.GRID)
            drawn = _draw_panel(axes, points, metric)
            panel_points.append((axes, drawn[["cost", "value", "method"]]))
            if metric == perceived:
                axes.set_yscale("log")
                style.plain_numbers(axes.yaxis)
            style.plain_numbers(axes.xaxis)
    style.label_panels(panel_points, 8)
    return figure


def _heading(metric: str) -> str:
    described = metrics_by_key()[metric]
    unit = f" in {described.unit}" if described.unit else ""
    return f"{described.name}{unit}, {described.better}er is better\n(bars: 95 % intervals)"


def _marker(look: Look) -> dict[str, Any]:
    return {"color": look.colour, "marker": look.marker, "linestyle": "", "markersize": 7}


def _draw_panel(axes: Axes, points: pd.DataFrame, metric: str) -> pd.DataFrame:
    """Draw the methods at their costs, and lines for others.

    Returns: the methods with a cost, the Pareto-optimal ones first.
    """
    errors = metric != "psnr_pooled"
    methods = points[~points["key"].isin([*LINES, RAY_TRACED])]
    measured = methods.dropna(subset="cost")
    for row in measured.itertuples():
        look = _marker(row.look) | ({"markerfacecolor": "none"} if row.learned == "False" else {})
        look |= EDGE if row.coded == "True" else {}
        value = f"{short(row.value)} [{short(row.low)}, {short(row.high)}]{'' if errors else ' dB'}"
        text = f"{row.method}: {value}; {axes.get_xlabel()}: {short(row.cost)}"
        point_with_interval(axes, row.cost, row.value, (row.low, row.high), text, **look)
    _draw_lines(axes, points, methods, errors)
    error = measured["value"].to_numpy() * (1 if errors else -1)
    first = measured.iloc[front(measured["cost"].to_numpy(), error)]
    axes.plot(first["cost"], first["value"], **FRONT, zorder=0)
    return pd.concat([first, measured.drop(first.index)])


def _draw_lines(axes: Axes, points: pd.DataFrame, methods: pd.DataFrame, errors: bool) -> None:
    """Draw qualities without a cost, and ray tracing's cost."""
    lines, maps = points[points["key"].isin(LINES)], methods["look"].eq(LOOKS["shadow_map"])
    if methods["cost"][maps].isna().all():  # maps are rendered anew in each frame
        lines = pd.concat([lines, methods[maps]])
    if len(lines) > 2:
        axes.set_xlim(left=axes.get_xlim()[0] / 4)  # room for their names
    for row in lines.itertuples():
        line = LINES.get(row.key, "-.")
        axes.axhline(row.value, zorder=0, color=GREY, linewidth=0.7, linestyle=line)
        name = row.method + PRINTED_NOTES[errors] * (row.key == PRINTED)
        look = {"transform": axes.get_yaxis_transform(), "fontsize": 7}
        if row.key == PRINTED:  # at the right, where no method is as bad
            below = "bottom" if errors else "top"
            axes.text(0.99, row.value, name, ha="right", va=below, **look)
        else:
            axes.text(0.01, row.value, name, va="bottom", **look)
    for cost in points["cost"][points["key"] == RAY_TRACED].dropna():
        axes.axvline(cost, color=GREY, linewidth=0.7, zorder=0)
        transform = axes.get_xaxis_transform()
        axes.text(cost, 0.02, " ray traced: exact", transform=transform, rotation=90, fontsize=7)

"""Loss and quality over training samples, with power laws.

Of screen-space networks squared errors over training frames.
"""

from collections.abc import Mapping, Sequence
from itertools import cycle
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import pandas as pd
from pydantic import Field

from neural_shadows.evaluation.look import COLOURS, GREY
from neural_shadows.metrics import power_law
from neural_shadows.metrics.power_law import Curve
from neural_shadows.metrics.registry import error_of, metrics, value_of
from neural_shadows.reports.data.curve_lines import EXTRAPOLATED, PREDICTED, by_kind
from neural_shadows.reports.data.table import read_table
from neural_shadows.reports.drawing import style
from neural_shadows.reports.drawing.chart import (
    point_with_interval,
    points_with_tooltips,
)
from neural_shadows.reports.drawing.style import Axes, Figure
from neural_shadows.reports.tables import learning_curves
from neural_shadows.sections.table_figures import RowsFigure
from neural_shadows.settings.records import Row

if TYPE_CHECKING:
    from matplotlib.transforms import Transform

Look = tuple[str, str]
"""Colour and marker of a method."""

MARKERS = ("o", "^", "v", "P", "X")
DECIBELS = "dB"  # already a logarithm: its axis is linear
NUMBERS = ("samples", "mean", *PREDICTED, "no_shadow", "thesis")


class Settings(RowsFigure):
    """Loss and quality over training samples, with predictions."""

    tables = (learning_curves.Settings,)
    kind: Literal["learning_curves"] = Field(description="`learning_curves`")


def draw(table_csv: Path, rows: Sequence[Row], heading: str) -> Figure:
    """Draw the learning curves of a scene.

    Args:
        rows: of the table, all of one scene.
    """
    numbers = (*NUMBERS, "base") if "steps" in rows[0] else NUMBERS
    curves = read_table(table_csv, ("scene", "method", "metric", "kind", "by_seed"), numbers)
    curves = curves[curves["scene"] == rows[0]["scene"]]
    return curves_figure(curves, looks_of(rows), title=heading)


def looks_of(rows: Sequence[Row]) -> dict[str, Look]:
    """Looks by label: on frames colours by network, markers by steps."""
    if "steps" not in rows[0]:
        return {row["label"]: (colour, MARKERS[0]) for row, colour in zip(rows, COLOURS)}
    colours = dict(zip(dict.fromkeys(row["experiment"] for row in rows), cycle(COLOURS)))
    markers = dict(zip(sorted({row["steps"] for row in rows}), cycle(MARKERS)))
    return {row["label"]: (colours[row["experiment"]], markers[row["steps"]]) for row in rows}


def curves_figure(table: pd.DataFrame, looks: Mapping[str, Look], *, title: str) -> Figure:
    """Draw a panel a metric, PSNR in dB, errors logarithmic.

    Args:
        table: of `curve_table` or `frames_table`, of one scene.
        looks: the methods, in the legend's order.
    """
    from matplotlib.lines import Line2D
    from matplotlib.transforms import ScaledTranslation

    table = table[table["method"].isin([*looks])]
    on_frames = "base" in table
    figure = style.new_figure(title, 11, 7 if on_frames else 8.2)
    level, level_name = (
        ("base", "the network's base, or the light map")
        if on_frames
        else ("no_shadow", "no shadow")
    )
    panels = [figure.subplots()] if on_frames else figure.subplots(2, 2).flat
    for axes, (metric, panel) in zip(panels, table.groupby("metric", sort=False)):
        for i, (label, look) in enumerate(looks.items()):
            # Beside the trainings of their budget, and beside each other.
            shift = ScaledTranslation((8 + 8 * i) / 72, 0, figure.dpi_scale_trans)
            part = panel[panel["method"] == label]
            _draw_curve(axes, metric, part, look, axes.transData + shift)
        _draw_levels(axes, metric, panel, level, looks)
        _format_axes(axes, metric, "training frames" if on_frames else "training samples")
        if on_frames:  # ten times the base's and more: a line would press the curves together
            far = _height(metric, panel["no_shadow"].max())
            axes.set_title(f"{metrics()[metric].heading} (no shadow: {far:,.0f})")
        if metric == "lpips" and panel["thesis"].notna().any():
            axes.set_title("LPIPS ↓ (the thesis's may be of another network)")
    shapes = {
        "a training": {"marker": "o", "markersize": 4},
        "power law of all but the largest budget": {"linestyle": "-"},
        "that law's prediction of the largest budget, drawn to its right, 90 %": {
            "marker": "D",
            "markerfacecolor": "white",
        },
        level_name: {"linestyle": ":"},
    }
    if table["thesis"].notna().any():
        shapes["as the thesis prints it"] = {"marker": "*", "markersize": 11}
    if table.loc[table["kind"] == EXTRAPOLATED, "predicted"].notna().any():
        shapes["extrapolated, 90 %"] = {"marker": "s", "markerfacecolor": "white"}
    marked = {marker for _, marker in looks.values()} > {MARKERS[0]}
    lines = [
        Line2D([], [], color=colour, marker=marker if marked else "", linewidth=3, label=label)
        for label, (colour, marker) in looks.items()
    ]
    others = [
        {"linestyle": "", "color": GREY, "label": name} | shape for name, shape in shapes.items()
    ]
    figure.legend(
        handles=[*lines, *(Line2D([], [], **other) for other in others)],
        loc="outside lower center",
        ncols=2 if on_frames else 3,
    )
    return figure


def _draw_levels(
    axes: Axes, metric: str, panel: pd.DataFrame, column: str, looks: Mapping[str, Look]
) -> None:
    """Draw the errors of a column, one line for all methods with the same."""
    for level, part in panel.groupby(column):
        colours = {looks[method][0] for method in part["method"]}
        of_method = len(colours) == 1 and len(looks) > 1
        colour = colours.pop() if of_method else GREY
        axes.axhline(_height(metric, level), color=colour, linewidth=1.2, linestyle=":")


def _draw_curve(
    axes: Axes, metric: str, part: pd.DataFrame, look: Look, transform: "Transform"
) -> None:
    """Draw a method's trainings, power law and predictions.

    The law is that of all budgets but the largest. Predictions have a `transform` of their own, a
    little to the right of the data.
    """
    colour, marker = look
    unit = "frames" if "base" in part else "samples"
    measured, extrapolated = by_kind(part)
    samples = measured["samples"].to_numpy()
    values = np.array([[float(value) for value in seeds.split()] for seeds in measured["by_seed"]])
    budgets = np.repeat(samples[:, None], values.shape[1], axis=1)
    name, method = metrics()[metric].heading, part["method"].iloc[0]
    texts = [
        f"{method}: {name} {metrics()[metric].factor * value:.4g} at {count:,.0f} {unit}"
        for value, count in zip(values.flat, budgets.flat)
    ]
    points = {"color": colour, "marker": marker, "markersize": 4, "alpha": 0.7}
    points_with_tooltips(axes, budgets.flat, _height(metric, values).flat, texts, **points)
    curve = Curve(samples, error_of(metric, values))
    if power_law.can_hold_out(curve):
        law = power_law.fit(Curve(samples[:-1], curve.values[:-1]))
        for ends, line in ((samples[[0, -2]], "-"), (samples[-2:], "--")):
            along = np.geomspace(*ends, 50)
            heights = _height(metric, value_of(metric, law(along)))
            axes.plot(along, heights, line, color=colour, linewidth=1.6)
        _draw_prediction(
            axes, metric, measured.iloc[-1], marker="D", color=colour, transform=transform
        )
    _draw_prediction(axes, metric, extrapolated, marker="s", color=colour, transform=transform)
    if np.isfinite(extrapolated["thesis"]):
        height = _height(metric, extrapolated["thesis"])
        axes.plot(extrapolated["samples"], height, "*", color=colour, ms=11)


def _draw_prediction(axes: Axes, metric: str, row: pd.Series, **look: Any) -> None:
    value, *ends = _height(metric, row[PREDICTED].to_numpy(float))
    look |= {"markerfacecolor": "white", "markersize": 6, "capsize": 3, "zorder": 4}
    text, low, high = (f"{metrics()[metric].factor * number:.4g}" for number in row[PREDICTED])
    text = f"{row['method']}, predicted: {metrics()[metric].heading} {text} [{low}, {high}]"
    # The ends of a complement's error swap.
    point_with_interval(axes, row["samples"], value, sorted(ends), text, **look)
    # What has a transform of its own does not widen the limits: bars were cut at the frame.
    axes.update_datalim([(row["samples"], end) for end in ends if np.isfinite(end)])


def _height(metric: str, values: float | np.ndarray) -> float | np.ndarray:
    """The drawn height: PSNR in dB, other metrics as errors, in their unit."""
    described = metrics()[metric]
    return values if described.unit == DECIBELS else described.factor * error_of(metric, values)


def _format_axes(axes: Axes, metric: str, samples: str) -> None:
    """Set a panel's scales, names and grid."""
    described = metrics()[metric]
    name = f"1 − {described.name} ↓" if described.is_complement else described.heading
    axes.set(xscale="log", xlabel=samples, title=name)
    axes.margins(x=0.12)  # room for the predictions at the right
    style.plain_numbers(axes.xaxis)
    if described.unit == DECIBELS:
        axes.set_ylabel(DECIBELS)
    else:
        axes.set_yscale("log")
        style.plain_numbers(axes.yaxis)
    axes.grid(which="both", **style.GRID)

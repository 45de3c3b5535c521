"""Learning curves: trainings by budget, power laws and predictions."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from neural_shadows.evaluation.look import GREY
from neural_shadows.metrics import power_law
from neural_shadows.metrics.power_law import Curve
from neural_shadows.metrics.registry import error_of, metrics, value_of
from neural_shadows.reports.data.curve_lines import EXTRAPOLATED, PREDICTED, by_kind
from neural_shadows.reports.drawing import style
from neural_shadows.reports.drawing.chart import point_with_interval, points_with_tooltips
from neural_shadows.reports.drawing.style import Axes, Figure

if TYPE_CHECKING:
    from matplotlib.transforms import Transform

Look = tuple[str, str]
"""Colour and marker of a method."""

MARKERS = ("o", "^", "v", "P", "X")
DECIBELS = "dB"  # already a logarithm: its axis is linear
NUMBERS = ("samples", "mean", *PREDICTED, "no_shadow", "thesis")
TEXTS = ("scene", "method", "metric", "kind", "by_seed")


def draw_panel(
    axes: Axes, metric: str, panel: pd.DataFrame, looks: Mapping[str, Look], level: str, unit: str
) -> None:
    """Draw the curves of a metric, PSNR in dB, errors logarithmic.

    Args:
        panel: rows of `metric_lines`, by `method`. looks: the methods, in the legend's order.
        level: column of an error that a line shows. unit: of a budget, such as `samples`.
    """
    from matplotlib.transforms import ScaledTranslation

    for i, (label, look) in enumerate(looks.items()):
        # Beside the trainings of their budget, and beside each other.
        shift = ScaledTranslation((8 + 8 * i) / 72, 0, axes.figure.dpi_scale_trans)
        part = panel[panel["method"] == label]
        _draw_curve(axes, metric, part, look, axes.transData + shift, unit)
    _draw_levels(axes, metric, panel, level, looks)
    _format_axes(axes, metric, f"training {unit}")


def draw_legend(
    figure: Figure, table: pd.DataFrame, looks: Mapping[str, Look], level: str, columns: int
) -> None:
    """Draw the legend below the panels.

    Args:
        table: of all panels. level: the words for the panels' `level`.
    """
    from matplotlib.lines import Line2D

    shapes = {
        "a training": {"marker": "o", "markersize": 4},
        "power law of all but the largest budget": {"linestyle": "-"},
        "that law's prediction of the largest budget, drawn to its right, 90 %": {
            "marker": "D",
            "markerfacecolor": "white",
        },
        level: {"linestyle": ":"},
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
        ncols=columns,
    )


def height_of(metric: str, values: float | np.ndarray) -> float | np.ndarray:
    """The drawn height: PSNR in dB, other metrics as errors, in their unit."""
    described = metrics()[metric]
    return values if described.unit == DECIBELS else described.factor * error_of(metric, values)


def _draw_levels(
    axes: Axes, metric: str, panel: pd.DataFrame, column: str, looks: Mapping[str, Look]
) -> None:
    """Draw the errors of a column, one line for all methods with the same."""
    for level, part in panel.groupby(column):
        colours = {looks[method][0] for method in part["method"]}
        of_method = len(colours) == 1 and len(looks) > 1
        colour = colours.pop() if of_method else GREY
        axes.axhline(height_of(metric, level), color=colour, linewidth=1.2, linestyle=":")


def _draw_curve(
    axes: Axes, metric: str, part: pd.DataFrame, look: Look, transform: "Transform", unit: str
) -> None:
    """Draw a method's trainings, power law and predictions.

    The law is that of all budgets but the largest. Predictions have a `transform` of their own, a
    little to the right of the data.
    """
    colour, marker = look
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
    points_with_tooltips(axes, budgets.flat, height_of(metric, values).flat, texts, **points)
    curve = Curve(samples, error_of(metric, values))
    if power_law.can_hold_out(curve):
        law = power_law.fit(Curve(samples[:-1], curve.values[:-1]))
        for ends, line in ((samples[[0, -2]], "-"), (samples[-2:], "--")):
            along = np.geomspace(*ends, 50)
            heights = height_of(metric, value_of(metric, law(along)))
            axes.plot(along, heights, line, color=colour, linewidth=1.6)
        _draw_prediction(
            axes, metric, measured.iloc[-1], marker="D", color=colour, transform=transform
        )
    _draw_prediction(axes, metric, extrapolated, marker="s", color=colour, transform=transform)
    if np.isfinite(extrapolated["thesis"]):
        height = height_of(metric, extrapolated["thesis"])
        axes.plot(extrapolated["samples"], height, "*", color=colour, ms=11)


def _draw_prediction(axes: Axes, metric: str, row: pd.Series, **look: Any) -> None:
    value, *ends = height_of(metric, row[PREDICTED].to_numpy(float))
    look |= {"markerfacecolor": "white", "markersize": 6, "capsize": 3, "zorder": 4}
    text, low, high = (f"{metrics()[metric].factor * number:.4g}" for number in row[PREDICTED])
    text = f"{row['method']}, predicted: {metrics()[metric].heading} {text} [{low}, {high}]"
    # The ends of a complement's error swap.
    point_with_interval(axes, row["samples"], value, sorted(ends), text, **look)
    # What has a transform of its own does not widen the limits: bars were cut at the frame.
    axes.update_datalim([(row["samples"], end) for end in ends if np.isfinite(end)])


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

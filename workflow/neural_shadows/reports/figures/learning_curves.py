"""Loss and quality over training samples, with power laws."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np
import pandas as pd
from pydantic import Field

from neural_shadows.evaluation.look import COLOURS
from neural_shadows.metrics import power_law
from neural_shadows.metrics.power_law import Curve
from neural_shadows.metrics.registry import error_of, metrics, value_of
from neural_shadows.reports.data.table import read_table
from neural_shadows.reports.data.trained import THESIS_SAMPLES
from neural_shadows.reports.drawing import style
from neural_shadows.reports.drawing.chart import (
    point_with_interval,
    points_with_tooltips,
    run_chart,
)
from neural_shadows.reports.drawing.style import Axes, Figure
from neural_shadows.reports.tables import learning_curves
from neural_shadows.reports.tables.learning_curves import EXTRAPOLATED, PREDICTED, by_kind
from neural_shadows.sections.any_report import Chapter
from neural_shadows.sections.table_figures import RowsFigure
from neural_shadows.settings.records import Row

if TYPE_CHECKING:
    from matplotlib.transforms import Transform

GREY = "#777777"
DECIBELS = "dB"  # already a logarithm: its axis is linear
NUMBERS = ("samples", "mean", *PREDICTED, "no_shadow", "thesis")


class Settings(RowsFigure):
    """Loss and quality over training samples, with predictions."""

    tables = (learning_curves.Settings,)
    chapter: ClassVar[Chapter] = "thesis"

    kind: Literal["learning_curves"] = Field(description="`learning_curves`")


def draw(table_csv: Path, rows: Sequence[Row], heading: str) -> Figure:
    """Draw the learning curves of a scene.

    Args:
        rows: of the table, all of one scene.
    """
    curves = read_table(table_csv, ("scene", "method", "metric", "kind", "by_seed"), NUMBERS)
    labels = [row["label"] for row in rows]
    curves = curves[(curves["scene"] == rows[0]["scene"]) & curves["method"].isin(labels)]
    return curves_figure(curves, labels, title=heading)


def curves_figure(table: pd.DataFrame, labels: Sequence[str], *, title: str) -> Figure:
    """Draw a panel a metric, PSNR in dB, errors logarithmic.

    Args:
        table: of `curve_table`, of one scene.
        labels: the methods, in the legend's order.
    """
    from matplotlib.lines import Line2D
    from matplotlib.transforms import ScaledTranslation

    colours = dict(zip(labels, COLOURS))
    figure = style.new_figure(title, 11, 8.2)
    for axes, (metric, panel) in zip(
        figure.subplots(2, 2).flat, table.groupby("metric", sort=False)
    ):
        for i, label in enumerate(labels):
            # Beside the trainings of their budget, and beside each other.
            shift = ScaledTranslation((8 + 8 * i) / 72, 0, figure.dpi_scale_trans)
            part = panel[panel["method"] == label]
            _draw_curve(axes, metric, part, colours[label], axes.transData + shift)
        for level, part in panel.groupby("no_shadow"):
            # One line for all methods, except for losses on rays of their own.
            methods = part["method"].unique()
            of_method = len(methods) == 1 and len(labels) > 1
            colour = colours[methods[0]] if of_method else GREY
            axes.axhline(_height(metric, level), color=colour, linewidth=1.2, linestyle=":")
        _format_axes(axes, metric)
        if metric == "lpips" and panel["thesis"].notna().any():
            axes.set_title("LPIPS ↓ (the thesis's may be of another network)")
    shapes = {
        "a training": {"marker": "o", "markersize": 4},
        "power law of all but the largest budget": {"linestyle": "-"},
        "its prediction there, 90 %": {"marker": "D", "markerfacecolor": "white"},
        "no shadow": {"linestyle": ":"},
    }
    if table["thesis"].notna().any():
        shapes["as the thesis prints it"] = {"marker": "*", "markersize": 11}
    if table.loc[table["kind"] == EXTRAPOLATED, "predicted"].notna().any():
        shapes["extrapolated, 90 %"] = {"marker": "s", "markerfacecolor": "white"}
    lines = [Line2D([], [], color=colours[label], linewidth=3, label=label) for label in labels]
    looks = [
        {"linestyle": "", "color": GREY, "label": name} | look for name, look in shapes.items()
    ]
    figure.legend(
        handles=[*lines, *(Line2D([], [], **look) for look in looks)],
        loc="outside lower center",
        ncols=3,
    )
    return figure


def _draw_curve(
    axes: Axes, metric: str, part: pd.DataFrame, colour: str, transform: "Transform"
) -> None:
    """Draw a method's trainings, power law and predictions.

    The law is that of all budgets but the largest. Predictions have a `transform` of their own, a
    little to the right of the data.
    """
    measured, extrapolated = by_kind(part)
    samples = measured["samples"].to_numpy()
    values = np.array([[float(value) for value in seeds.split()] for seeds in measured["by_seed"]])
    budgets = np.repeat(samples[:, None], values.shape[1], axis=1)
    name, method = metrics()[metric].heading, part["method"].iloc[0]
    texts = [
        f"{method}: {name} {value:.4g} at {count:,.0f} samples"
        for value, count in zip(values.flat, budgets.flat)
    ]
    look = {"color": colour, "markersize": 4, "alpha": 0.7}
    points_with_tooltips(axes, budgets.flat, _height(metric, values).flat, texts, **look)
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
        axes.plot(THESIS_SAMPLES, _height(metric, extrapolated["thesis"]), "*", color=colour, ms=11)


def _draw_prediction(axes: Axes, metric: str, row: pd.Series, **look: Any) -> None:
    value, *ends = _height(metric, row[PREDICTED].to_numpy(float))
    look |= {"markerfacecolor": "white", "markersize": 6, "capsize": 3, "zorder": 4}
    text, low, high = (f"{number:.4g}" for number in row[PREDICTED])
    text = f"{row['method']}, predicted: {metrics()[metric].heading} {text} [{low}, {high}]"
    # The ends of a complement's error swap.
    point_with_interval(axes, row["samples"], value, sorted(ends), text, **look)


def _height(metric: str, values: float | np.ndarray) -> float | np.ndarray:
    """The drawn height: PSNR in dB, other metrics as errors."""
    return values if metrics()[metric].unit == DECIBELS else error_of(metric, values)


def _format_axes(axes: Axes, metric: str) -> None:
    """Set a panel's scales, names and grid."""
    described = metrics()[metric]
    name = f"1 − {described.name} ↓" if described.is_complement else described.heading
    axes.set(xscale="log", xlabel="training samples", title=name)
    axes.margins(x=0.12)  # room for the predictions at the right
    style.plain_numbers(axes.xaxis)
    if described.unit == DECIBELS:
        axes.set_ylabel(DECIBELS)
    else:
        axes.set_yscale("log")
        style.plain_numbers(axes.yaxis)
    axes.grid(which="both", **style.GRID)


if "snakemake" in globals():
    run_chart(snakemake, draw)

"""Training loss of networks over samples [figures 4.1 to 4.3]."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pandas as pd
from pydantic import Field

from neural_shadows.evaluation.look import COLOURS
from neural_shadows.files.whole_files import read_json
from neural_shadows.layout.layout import Layout
from neural_shadows.layout.tables import networks
from neural_shadows.reports.data.digits import short
from neural_shadows.reports.drawing import style
from neural_shadows.reports.drawing.chart import points_with_tooltips
from neural_shadows.reports.drawing.style import Figure
from neural_shadows.sections.any_report import AnyFigure
from neural_shadows.sections.experiments import RayExperimentName
from neural_shadows.sections.sections import Sections
from neural_shadows.settings.base import Model, Text, section_or
from neural_shadows.training.loss_curve import read_loss

PARTS = 60  # of a curve, each drawn as its mean
POINTS = ["samples", "loss"]
SAYING = 6  # every so many of them has a tooltip


class Curve(Model):
    """A curve with a label of its own."""

    experiment: RayExperimentName = Field(description="an experiment on rays")
    label: Text | None = Field(None, description="without it the experiment's label")


class Settings(AnyFigure):
    """Training loss over steps [figures 4.1 to 4.3]."""

    kind: Literal["loss"] = Field(description="`loss`")
    curves: list[section_or(Curve, "experiment")] = Field(
        min_length=1, description="experiments, in the legend's order"
    )

    def check(self, config: Sections, key: str) -> None:
        for curve in self.curves:
            config.label_of(curve.experiment, curve.label)
            if config.ray_experiments[curve.experiment].training is None:
                raise ValueError(
                    f"{key}.curves: {curve.experiment!r} is built without training and has no loss. "
                    "Leave it out"
                )

    def resolved(self, config: Sections) -> dict[str, Any]:
        names = ((curve.experiment, curve.label) for curve in self.curves)
        curves = [
            {"experiment": name, "label": config.label_of(name, label)} for name, label in names
        ]
        return self.model_dump() | {"curves": curves}


def files(layout: Layout, figure: str) -> dict[str, Any]:
    curves = layout.entry("figures", figure)["curves"]
    return {
        "losses": networks(layout, curves, "loss.csv"),
        "trainings": networks(layout, curves, "training.json"),
    }


def draw(
    losses: list[Path],
    trainings: list[Path],
    heading: str,
    curves: Sequence[Mapping[str, str]],
) -> tuple[Figure, pd.DataFrame]:
    """Draw the loss curves of experiments.

    Args:
        losses: `loss.csv` of each experiment, in a folder of its name.
        trainings: `training.json` of each.
        curves: see `Curve`, in the legend's order.
    """
    paths = {path.parent.name: path for path in losses}
    diverged = {record["name"]: record["died_at_step"] for record in map(read_json, trainings)}
    tables, ends = {}, {}
    for curve in curves:
        tables[curve["label"]] = read_loss(paths[curve["experiment"]])
        ends[curve["label"]] = diverged[curve["experiment"]]
    figure = loss_figure(tables, ends, title=heading)
    data = [means_of(frame).assign(curve=label) for label, frame in tables.items()]
    return figure, pd.concat(data)


def smoothed(values: np.ndarray) -> np.ndarray:
    """Means of a curve (n,) over logarithmically even parts."""
    starts = np.unique(np.geomspace(1, len(values), PARTS).astype(int)) - 1
    return np.add.reduceat(values, starts) / np.diff(starts, append=len(values))


def means_of(curve: pd.DataFrame) -> pd.DataFrame:
    """Smoothed `samples` and `loss` up to a curve's divergence."""
    finite = curve.loc[np.isfinite(curve["loss"]), POINTS].astype(float)
    means = {name: smoothed(finite[name].to_numpy()) if len(finite) else [] for name in POINTS}
    return pd.DataFrame(means)


def loss_figure(
    curves: Mapping[str, pd.DataFrame], diverged: Mapping[str, int | None], *, title: str
) -> Figure:
    """Draw loss over samples, both logarithmic, with means.

    Args:
        curves: see `read_loss`, by label in the legend's order.
        diverged: the step of divergence, by label; the curve ends there with a cross.
    """
    figure = style.new_figure(title, 9, 5.4)
    axes = figure.subplots()
    drawn = {label: curve[np.isfinite(curve["loss"])] for label, curve in curves.items()}
    for i, (label, curve) in enumerate(drawn.items()):
        points = curve[POINTS].to_numpy(float).T
        colour = COLOURS[i % len(COLOURS)]
        step = diverged[label]
        end = f"at the end {short(points[1, -1])}" if step is None else f"diverged at step {step:,}"
        if not len(curve):  # diverged before the first point
            axes.plot([], [], color=colour, label=f"{label} ({end})")
            continue
        axes.plot(*points, color=colour, alpha=0.25, linewidth=0.8)
        axes.plot(*map(smoothed, points), color=colour, linewidth=1.8, label=f"{label} ({end})")
        if step is not None:
            axes.plot(*points[:, -1:], color=colour, marker="X", markersize=10)
    axes.set(xscale="log", yscale="log", xlabel="training samples", ylabel="dead-zone loss")
    for i, (label, curve) in enumerate(curves.items()):
        points = means_of(curve)[::-SAYING].to_numpy()
        texts = [f"{label}: {short(loss)} at {count:,.0f} samples" for count, loss in points]
        look = {"color": COLOURS[i % len(COLOURS)], "markersize": 3.5}
        points_with_tooltips(axes, *points.T, texts, **look)
    # A spike in the first points, of an untrained network, would squeeze the rest.
    settled = [curve["loss"].iloc[len(curve) // 100 :].max() for curve in drawn.values()]
    axes.set_ylim(top=min(axes.get_ylim()[1], 3 * np.nanmax(settled)))
    style.plain_numbers(axes.yaxis)
    axes.grid(which="both", **style.GRID)
    axes.legend()
    return figure

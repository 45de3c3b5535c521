"""Training loss of several networks over their samples [figures 4.1 to 4.3]."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from neural_shadows.reports.figures import style
from neural_shadows.running.stage import run_stage
from neural_shadows.training.loss_curve import read_loss

PARTS = 60  # of a curve that is drawn as means


def draw(
    losses: list[Path],
    png: Path,
    svg: Path,
    *,
    title: str,
    curves: Sequence[Mapping[str, str]],
    run: style.Section,
) -> None:
    """Draw the loss curves of experiments.

    Args:
        losses: `loss.csv` of each experiment, in a folder of its name.
        curves: `experiment` and `label`, in the legend's order.

    Raises:
        InputError: a loss curve is missing or not whole.
    """
    files = {path.parent.name: path for path in losses}
    frames = {curve["label"]: read_loss(files[curve["experiment"]]) for curve in curves}
    style.write_figure(loss_figure(frames, title=f"{title} ({run['scale']} scale)"), png, svg)


def smoothed(values: np.ndarray) -> np.ndarray:
    """Means of a curve (n,) over parts of it that are equally wide on a logarithmic axis."""
    starts = np.unique(np.geomspace(1, len(values), PARTS).astype(int)) - 1
    return np.add.reduceat(values, starts) / np.diff(starts, append=len(values))


def loss_figure(curves: Mapping[str, pd.DataFrame], *, title: str) -> Figure:
    """Draw loss over samples, both logarithmic; the points pale, and their means.

    Args:
        curves: as `read_loss` gives them, by label in the legend's order.
    """
    figure = style.new_figure(title, 9, 5.4)
    axes = figure.subplots()
    for i, (label, curve) in enumerate(curves.items()):
        points = curve[["samples", "loss"]].to_numpy(float).T
        colour = style.COLOURS[i % len(style.COLOURS)]
        axes.plot(*points, color=colour, alpha=0.25, linewidth=0.8)
        text = f"{label} (at the end {points[1, -1]:.3g})"
        axes.plot(*map(smoothed, points), color=colour, linewidth=1.8, label=text)
    axes.set(xscale="log", yscale="log", xlabel="training samples", ylabel="dead-zone loss")
    # A spike in the first points, of a network that knows nothing yet, would squeeze the rest.
    settled = max(curve["loss"].iloc[len(curve) // 100 :].max() for curve in curves.values())
    axes.set_ylim(top=min(axes.get_ylim()[1], 3 * settled))
    style.plain_numbers(axes.yaxis)
    axes.grid(which="both", **style.GRID)
    axes.legend()
    return figure


if "snakemake" in globals():
    run_stage(snakemake, draw)

"""Training loss of several networks over their samples [figures 4.1 to 4.3]."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd
from matplotlib.figure import Figure

from neural_shadows.reports.figures.style import COLOURS, GRID, new_figure, write_figure
from neural_shadows.running.stage import run_stage
from neural_shadows.training.loss_curve import read_loss

SMOOTHING = 0.02  # of the curve's points, each the mean of a five hundredth of the run


def draw(
    losses: list[Path],
    png: Path,
    svg: Path,
    *,
    title: str,
    curves: Sequence[Mapping[str, str]],
    run: Mapping[str, Any],
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
    write_figure(loss_figure(frames, title=f"{title} ({run['scale']} scale)"), png, svg)


def loss_figure(curves: Mapping[str, pd.DataFrame], *, title: str) -> Figure:
    """Draw loss over samples, both logarithmic; the points pale and their running mean.

    Args:
        curves: as `read_loss` gives them, by label in the legend's order.
    """
    figure = new_figure(title, 9, 5.4)
    axes = figure.subplots()
    for i, (label, curve) in enumerate(curves.items()):
        samples, loss, colour = curve["samples"], curve["loss"], COLOURS[i % len(COLOURS)]
        # At the ends the points themselves: a mean of one side would be off where a loss falls.
        window = 2 * round(SMOOTHING * len(loss) / 2) + 1
        mean = loss.rolling(window, center=True).mean().fillna(loss)
        axes.plot(samples, loss, color=colour, alpha=0.25, linewidth=0.8)
        text = f"{label} (at the end {loss.iloc[-1]:.3g})"
        axes.plot(samples, mean, color=colour, linewidth=1.8, label=text)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("training samples")
    axes.set_ylabel("dead-zone loss")
    axes.grid(which="both", **GRID)
    axes.legend()
    return figure


if "snakemake" in globals():
    run_stage(snakemake, draw)

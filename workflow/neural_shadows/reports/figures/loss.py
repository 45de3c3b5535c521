"""Training loss of several networks over their samples [figures 4.1 to 4.3]."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from neural_shadows.reports.figures.style import COLOURS, DPI, write_strip
from neural_shadows.training.loss_curve import read_loss

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SMOOTHING = 0.02  # of the curve's points, each the mean of a five hundredth of the run


def smoothed(values: np.ndarray) -> np.ndarray:
    """Running mean of a curve (n,), over as many points on either side, fewer at its ends: (n,)."""
    i = np.arange(len(values))
    reach = np.minimum(np.minimum(i, i[::-1]), round(SMOOTHING * len(values) / 2))
    total = np.concatenate([[0.0], np.cumsum(values)])
    return (total[i + reach + 1] - total[i - reach]) / (2 * reach + 1)


def loss_figure(curves: Mapping[str, pd.DataFrame], *, title: str) -> Figure:
    """Draw loss over samples, both logarithmic; the points pale and their running mean.

    Args:
        curves: as `read_loss` gives them, by label in the legend's order.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9, 5.4), dpi=DPI, layout="constrained")
    axes = figure.subplots()
    for i, (label, curve) in enumerate(curves.items()):
        colour = COLOURS[i % len(COLOURS)]
        axes.plot(curve["samples"], curve["loss"], color=colour, alpha=0.25, linewidth=0.8)
        axes.plot(
            curve["samples"],
            smoothed(curve["loss"].to_numpy()),
            color=colour,
            linewidth=1.8,
            label=f"{label} (at the end {curve['loss'].iloc[-1]:.3g})",
        )
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("training samples")
    axes.set_ylabel("dead-zone loss")
    axes.set_title(title, loc="left", weight="bold")
    axes.grid(which="both", linewidth=0.4, alpha=0.4)
    axes.legend()
    return figure


def write_loss_figure(
    losses: Sequence[Path], png: Path, svg: Path, *, title: str, labels: Sequence[str], scale: str
) -> None:
    """Draw the loss curves in these files under their labels."""
    curves = {label: read_loss(path) for label, path in zip(labels, losses, strict=True)}
    write_strip(loss_figure(curves, title=f"{title} ({scale} scale)"), png, svg)

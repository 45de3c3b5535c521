"""Training loss of several networks over their samples [figures 4.1 to 4.3]."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from neural_shadows.broken import broken, reading
from neural_shadows.csv_file import read_csv
from neural_shadows.strips import DPI, write_strip

if TYPE_CHECKING:
    from matplotlib.figure import Figure

COLUMNS = {"step": "int64", "samples": "int64", "learning_rate": "float64", "loss": "float64"}
# Okabe and Ito's colours, which readers with any colour vision tell apart.
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000")
SMOOTHING = 0.02  # of the curve's points, each the mean of a five hundredth of the run


def read_loss(path: str | Path) -> pd.DataFrame:
    """Read a training's loss curve: `step, samples, learning_rate, loss`, a row per point.

    Raises:
        InputError: the file is missing; or cut short or no loss curve, and moved aside.
    """
    with reading(path, "loss curve"):
        curve = read_csv(path, COLUMNS)
    if curve.empty or not np.isfinite(curve).all(axis=None):
        raise broken(path, "not a whole loss curve (a value is missing or not finite)")
    return curve


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

"""Modelled over measured widths of penumbrae [Datta et al., 3.6]."""

from math import ceil
from pathlib import Path
from typing import Literal

import numpy as np
from pydantic import Field

from neural_shadows.evaluation.look import ORANGE
from neural_shadows.reports.data.lights import light_names
from neural_shadows.reports.drawing.style import (
    GRID,
    Figure,
    legend_below,
    new_figure,
    plain_numbers,
)
from neural_shadows.sections.any_report import AnyFigure
from neural_shadows.sections.frame_sets import FrameSetName
from neural_shadows.sections.frame_tables import check_penumbrae
from neural_shadows.sections.sections import Sections

PANEL, MOST_COLUMNS = 4.0, 3  # inches of a light's histogram, and histograms in a line
SCALE = 1.0  # inches of the scale of their colours
CELLS, MEDIANS = 60, 15  # along an axis; FEWEST: pixels of a median
FEWEST = 10


class Settings(AnyFigure):
    """Widths of penumbrae by the model, over measured widths."""

    own_chapter = "soft"

    kind: Literal["penumbra_model"] = Field(description="`penumbra_model`")
    frame_set: FrameSetName = Field(description="a name in `frame_sets`, but `views`")

    def check(self, config: Sections, key: str) -> None:
        check_penumbrae(config, key, self.frame_set)


def draw(first_parts: list[Path], soft_meshes: list[Path], heading: str) -> Figure:
    """Draw modelled over measured widths of penumbra pixels.

    Args:
        first_parts: of test frames; the first of each is used. soft_meshes: see `measured_frames`.
    """
    from neural_shadows.evaluation.measured_frames import measured_frames
    from neural_shadows.evaluation.measured_penumbrae import widths

    frames = [frame for frame in measured_frames(first_parts, soft_meshes) if frame.number == 0]
    names = light_names(frames[0].part.about)
    pairs_by_light = {
        names[k]: np.concatenate([widths(frame, k) for frame in frames], axis=1)
        for k, radius in enumerate(frames[0].part.radii)
        if radius > 0
    }
    return model_figure(pairs_by_light, title=heading)


def model_figure(pairs_by_light: dict[str, np.ndarray], *, title: str) -> Figure:
    """Draw a histogram for each light, with medians of the model.

    Args:
        pairs_by_light: measured and modelled widths (2, n), pixels.
    """
    from matplotlib.colors import LogNorm

    from neural_shadows.evaluation.measured_penumbrae import NARROWEST

    rows = ceil(len(pairs_by_light) / MOST_COLUMNS)
    columns = ceil(len(pairs_by_light) / rows)
    figure = new_figure(title, max(PANEL * columns + SCALE, 6.5), 1.3 + (PANEL + 0.4) * rows)
    panels = figure.subplots(rows, columns, squeeze=False).ravel()
    largest = max(pairs.max(initial=10.0) for pairs in pairs_by_light.values())
    ends = 1.0, float(largest)
    edges = np.geomspace(*ends, CELLS + 1)
    counts = {
        light: np.histogram2d(*pairs, [edges, edges])[0].T
        for light, pairs in pairs_by_light.items()
    }
    most = max(count.max() for count in counts.values())
    look = {"cmap": "Blues", "norm": LogNorm(1, max(most, 2)), "rasterized": True}
    for axes, (light, pairs) in zip(panels, pairs_by_light.items()):
        axes.set_title(light, fontsize=10)
        axes.plot(ends, ends, color="#777777", linewidth=0.8, label="equal")
        axes.set(xscale="log", yscale="log", xlim=ends, ylim=ends, aspect="equal")
        axes.set(xlabel="measured width, pixels", ylabel="width by the model, pixels")
        axes.grid(**GRID)
        for axis in (axes.xaxis, axes.yaxis):
            plain_numbers(axis)
        if not pairs.size:
            none = f"No penumbra of these frames\nis {NARROWEST:g} pixels wide."
            axes.text(0.05, 0.9, none, transform=axes.transAxes, va="top")
            continue
        cells = axes.pcolormesh(edges, edges, np.ma.masked_equal(counts[light], 0), **look)
        median = {"color": ORANGE, "linewidth": 2, "marker": "o", "markersize": 4}
        axes.plot(*_medians(pairs, edges), label="median of the model", **median)
        # In this corner lies nothing: the model's widths are `NARROWEST` and more.
        place = {"transform": axes.transAxes, "ha": "right", "va": "bottom", "fontsize": 9}
        axes.text(0.97, 0.03, _numbers(*pairs), **place)
    for axes in panels[len(pairs_by_light) :]:
        axes.set_axis_off()
    if most:
        figure.colorbar(cells, ax=panels, label="pixels", shrink=0.6, aspect=30)
    legend_below(figure)
    return figure


def _numbers(measured: np.ndarray, modelled: np.ndarray) -> str:
    return (
        f"model ≥ measured: {100 * np.mean(modelled >= measured):.0f} % of pixels\n"
        f"median ratio: {np.median(modelled / measured):.2g}\n"
        f"95 % of the model ≤ {np.percentile(modelled, 95):.0f} pixels"
    )


def _medians(pairs: np.ndarray, edges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Modelled width's median by measured width; NaN of bins with few pixels."""
    edges = edges[:: CELLS // MEDIANS]
    bins = np.digitize(pairs[0], edges)
    modelled = [pairs[1][bins == k] for k in range(1, len(edges))]
    medians = [np.median(widths) if len(widths) >= FEWEST else np.nan for widths in modelled]
    return np.sqrt(edges[:-1] * edges[1:]), np.array(medians)

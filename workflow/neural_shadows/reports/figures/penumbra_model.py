"""Modelled over measured widths of penumbrae [Datta et al., 3.6]."""

from math import ceil
from pathlib import Path
from typing import ClassVar, Literal

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
    run_figure,
)
from neural_shadows.sections.any_report import AnyFigure, Chapter
from neural_shadows.sections.frame_sets import FrameSetName
from neural_shadows.sections.own_frames import OwnFrames
from neural_shadows.sections.sections import Sections

PANEL, MOST_COLUMNS = 4.0, 3  # inches of a light's histogram, and histograms in a line
CELLS, MEDIANS = 60, 15  # along an axis; FEWEST: pixels of a median
FEWEST = 10


class Settings(AnyFigure):
    """Widths of penumbrae by the model, over measured widths."""

    chapter: ClassVar[Chapter] = "soft"

    kind: Literal["penumbra_model"] = Field(description="`penumbra_model`")
    frame_set: FrameSetName = Field(description="a name in `frame_sets`, but `views`")

    def check(self, config: Sections, key: str) -> None:
        if isinstance(config.frame_sets[self.frame_set], OwnFrames):
            raise ValueError(
                f"{key}.frame_set: {self.frame_set!r} is of a user's own frames, which have "
                "no scene. Choose another frame set"
            )


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
    from neural_shadows.evaluation.measured_penumbrae import NARROWEST

    rows = ceil(len(pairs_by_light) / MOST_COLUMNS)
    columns = ceil(len(pairs_by_light) / rows)
    figure = new_figure(title, max(PANEL * columns, 6.5), 1.3 + (PANEL + 0.4) * rows)
    panels = figure.subplots(rows, columns, squeeze=False).ravel()
    largest = max(pairs.max(initial=10.0) for pairs in pairs_by_light.values())
    ends = 1.0, float(largest)
    edges = np.geomspace(*ends, CELLS + 1)
    for axes, (light, pairs) in zip(panels, pairs_by_light.items()):
        axes.plot(ends, ends, color="#777777", linewidth=0.8, label="equal")
        axes.set(xscale="log", yscale="log", xlim=ends, ylim=ends, aspect="equal")
        axes.set(xlabel="measured width, pixels", ylabel="width by the model, pixels")
        axes.grid(**GRID)
        for axis in (axes.xaxis, axes.yaxis):
            plain_numbers(axis)
        if not pairs.size:
            axes.set_title(light, fontsize=10)
            none = f"No penumbra of these frames\nis {NARROWEST:g} pixels wide."
            axes.text(0.05, 0.9, none, transform=axes.transAxes, va="top")
            continue
        counts = np.histogram2d(*pairs, [edges, edges])[0].T
        look = {"cmap": "Blues", "norm": "log", "rasterized": True}
        axes.pcolormesh(edges, edges, np.ma.masked_equal(counts, 0), **look)
        axes.plot(*_medians(pairs, edges), color=ORANGE, linewidth=2, label="median of the model")
        above, ratio = np.mean(pairs[1] >= pairs[0]), np.median(pairs[1] / pairs[0])
        axes.set_title(
            f"{light}\nmodel ≥ measured in {100 * above:.0f} % of pixels,\nmedian ratio {ratio:.2g}, "
            f"95 % of its widths ≤ {np.percentile(pairs[1], 95):.0f} px",
            fontsize=9,
        )
    for axes in panels[len(pairs_by_light) :]:
        axes.set_axis_off()
    legend_below(figure)
    return figure


def _medians(pairs: np.ndarray, edges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Modelled width's median by measured width, of well filled bins."""
    edges = edges[:: CELLS // MEDIANS]
    bins = np.digitize(pairs[0], edges)
    filled = [k for k in range(1, len(edges)) if (bins == k).sum() >= FEWEST]
    middles = np.sqrt(edges[:-1] * edges[1:])[[k - 1 for k in filled]]
    return middles, np.array([np.median(pairs[1][bins == k]) for k in filled])


if "snakemake" in globals():
    run_figure(snakemake, draw)

"""Small views by each method, with errors and scores."""

import textwrap
from collections.abc import Mapping, Sequence
from math import ceil
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar, Literal

import numpy as np
from pydantic import Field

from neural_shadows.evaluation.metric_files import read_view_metrics
from neural_shadows.files.whole_files import read_json
from neural_shadows.metrics.pooled_psnr import identical
from neural_shadows.reports.data.method_look import REFERENCE
from neural_shadows.reports.drawing.style import (
    Figure,
    frame_picture,
    new_figure,
    note_below,
)
from neural_shadows.reports.tables import comparison, networks
from neural_shadows.scenes.cameras import VIEW_SETS
from neural_shadows.sections.table_figures import MethodsFigure
from neural_shadows.settings.records import Row, Run

if TYPE_CHECKING:
    from neural_shadows.reports.data.frames import Frame

MOST_VIEWS = 24  # of a view set; of more, so many at even steps
MOST_COLUMNS, FEWEST_COLUMNS = 8, 4
PIXELS = 200  # across a small view, or a few more
NOTE = (
    "Below each view: its number from 1, and its PSNR in dB or that it equals the reference. "
    "Wrong pixels are drawn larger than they are."
)
WIDTH = 12.0  # inches: on a page of 1168 px a view is 145 px wide


class Settings(MethodsFigure):
    """All views by each method, small."""

    tables = (comparison.Settings, networks.Settings)
    folded: ClassVar[bool] = True

    kind: Literal["contact_sheet"] = Field(description="`contact_sheet`")


def draw(
    metrics: list[Path],
    references: list[Path],
    visibilities: list[Path],
    mesh_json: Path,
    title: str,
    rows: Sequence[Row],
    run: Run,
) -> Figure:
    """Draw the views of each view set by each method.

    Args:
        metrics, references, visibilities: of all batches, see `read_frames`.
    """
    from neural_shadows.reports.data.frames import read_frames

    values = read_view_metrics(metrics)
    frames = {}
    for view_set, numbers in values.groupby("view_set")["view"].unique().items():
        numbers = np.sort(numbers)
        count = min(len(numbers), MOST_VIEWS)
        indices = np.linspace(0, len(numbers) - 1, count).round().astype(int)
        views = [(view_set, number) for number in numbers[indices]]
        frames[view_set] = read_frames(references, visibilities, values, views)
    mesh = read_json(mesh_json)["name"]
    heading = f"{title} ({mesh}, {run['scale']} scale)"
    labels = {row["method"]: row["label"] for row in rows}
    return contact_sheet(frames, labels, heading)


def contact_sheet(
    frames: Mapping[str, Sequence["Frame"]], labels: Mapping[str, str], title: str
) -> Figure:
    """Draw the view sets' small views, rows alternating by method.

    Args:
        frames: by view set; all images of one shape.
        labels: of the methods, in order.
    """
    from neural_shadows.reports.data.frame_errors import error_legend, with_errors

    largest = max(map(len, frames.values()))
    columns = min(max(largest, FEWEST_COLUMNS), MOST_COLUMNS)
    rows = [len(labels) * ceil(len(views) / columns) for views in frames.values()]
    height, width = next(iter(frames.values()))[0].images[REFERENCE].shape
    step = max(1, width // PIXELS)
    heights = [0.3 + (WIDTH / columns * height / width + 0.2) * count for count in rows]
    figure = new_figure(title, WIDTH, 0.8 + sum(heights))
    figure.get_layout_engine().set(w_pad=0.02, h_pad=0.02, hspace=0, wspace=0)
    figure.legend(handles=error_legend(), loc="outside upper right", ncols=2)
    note_below(figure, NOTE)
    parts = figure.subfigures(len(frames), squeeze=False, height_ratios=heights).flat
    for part, (view_set, views), count in zip(parts, frames.items(), rows):
        heading = f"The views {VIEW_SETS[view_set]}"
        part.suptitle(heading, x=0.005, ha="left", fontsize=11, weight="bold")
        panels = part.subplots(count, columns, squeeze=False)
        for axes in panels.flat:
            frame_picture(axes, "none")
        for j, (method, label) in enumerate(labels.items()):
            lines = panels[j :: len(labels)]
            for line in lines:
                line[0].set_ylabel(textwrap.fill(label, 18), fontsize=8)
            for axes, frame in zip(lines.flat, views):
                image = with_errors(frame.images[method], frame.images[REFERENCE], 2 * step - 1)
                axes.imshow(image[::step, ::step], interpolation="none")
                psnr = frame.scores[method]["psnr"]
                score = "equal" if identical(psnr) else f"{psnr:.1f}"
                axes.set_xlabel(f"{frame.view[1] + 1}: {score}", fontsize=9, labelpad=2)
    return figure

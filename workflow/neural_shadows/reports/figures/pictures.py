"""Picture strips by method, with crops [figures 4.4–4.7]."""

import textwrap
from collections.abc import Mapping, Sequence
from math import ceil
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from pydantic import Field

from neural_shadows.evaluation.look import YELLOW, Look
from neural_shadows.evaluation.metric_files import read_view_metrics
from neural_shadows.evaluation.null_predictors import NO_SHADOW
from neural_shadows.files.whole_files import read_json
from neural_shadows.layout import tables
from neural_shadows.layout.layout import Layout
from neural_shadows.metrics.registry import metrics as metrics_by_key
from neural_shadows.reports.data.chosen_views import RULE, choose_views
from neural_shadows.reports.data.learned import learned_methods, margins
from neural_shadows.reports.data.method_look import LOOKS, REFERENCE, look_of
from neural_shadows.reports.data.published import read_published
from neural_shadows.reports.data.quality import values_by_view
from neural_shadows.reports.drawing.style import (
    Axes,
    Figure,
    frame_picture,
    new_figure,
    note_below,
)
from neural_shadows.reports.tables import comparison, networks
from neural_shadows.sections.scenes import ViewSet
from neural_shadows.sections.sections import Sections
from neural_shadows.sections.table_figures import MethodsFigure
from neural_shadows.settings.base import check_among
from neural_shadows.settings.records import Row, Run

if TYPE_CHECKING:
    from neural_shadows.reports.data.frame_errors import Window
    from neural_shadows.reports.data.frames import Frame

MOST_COLUMNS = 4  # of methods in a line; more go to a line of their own
WIDTH = 12.0  # inches, 1800 px: on a page of 1168 px the names are 14 px high
LETTERS = 120  # of the bold names, across the figure
HEAD = 0.6  # inches of a line's names and scores

NOT_LEARNED = "\n(not learned)"  # under the name
SCORES = {"psnr": 1, "lpips": 4}  # digits


class Settings(MethodsFigure):
    """Viewpoints by each method, with crops [figures 4.4 to 4.7]."""

    tables = (comparison.Settings, networks.Settings)

    kind: Literal["pictures"] = Field(description="`pictures`")
    view_sets: list[ViewSet] = Field(min_length=1, description="a view of each is shown")

    def check(self, config: Sections, key: str) -> None:
        super().check(config, key)
        view_sets = config.scenes[self.scene_of(config)].view_sets
        for view_set in self.view_sets:
            check_among(f"{key}.view_sets", view_set, view_sets)


def files(layout: Layout, figure: str) -> dict[str, Any]:
    settings = layout.entry("figures", figure)
    # No shadow's decide whether a network has learned.
    rows = [*settings["rows"], *tables.unshadowed([settings["scene"]])]
    return {"metrics": tables.evaluations(layout, rows, "csv")}


def draw(
    metrics: list[Path],
    references: list[Path],
    visibilities: list[Path],
    mesh_json: Path,
    published_csv: Path,
    title: str,
    rows: Sequence[Row],
    view_sets: Sequence[str],
    run: Run,
) -> Figure:
    """Draw a frame of each view set by every method.

    Args:
        metrics: of all batches of each method and of no shadow.
        references, visibilities: of all batches, see `read_frames`.
    """
    from neural_shadows.reports.data.frames import read_frames

    measured = dict.fromkeys([NO_SHADOW, *(row["method"] for row in rows)])
    values = read_view_metrics(metrics)
    by_view = values_by_view(values, [*measured])
    run_margins = margins(read_published(published_csv))
    learned = learned_methods(by_view, rows, run_margins, run["seed"])
    labels = {row["method"]: row["label"] for row in rows}
    labels |= {method: labels[method] + NOT_LEARNED for method in learned if not learned[method]}
    heads = {row["method"]: (labels[row["method"]], look_of(row)) for row in rows}
    chosen = choose_views(values)
    frames = read_frames(references, visibilities, values, [chosen[name] for name in view_sets])
    mesh = read_json(mesh_json)["name"]
    heading = f"{title} ({mesh}, {run['scale']} scale)"
    return picture_strip(frames, heads, heading)


def picture_strip(
    frames: Sequence["Frame"], heads: Mapping[str, tuple[str, Look]], title: str
) -> Figure:
    """Draw whole frames, and below each its crops with errors.

    Args:
        frames: viewpoints, all images of one shape, with `reference`, drawn last as in the thesis.
            Their scores are written below the names.
        heads: the name and the look of each method to draw, in the order to draw them.
    """
    from neural_shadows.reports.data.frame_errors import choose_crops, error_legend, with_errors

    heads = {**heads, REFERENCE: ("Reference", LOOKS[REFERENCE])}
    lines = ceil(len(heads) / MOST_COLUMNS)
    columns = ceil(len(heads) / lines)
    rows, across = frames[0].images[REFERENCE].shape
    # A frame, and crops of half its width.
    pictures = 1.5 * WIDTH / columns * rows / across
    height = 1.1 + len(frames) * (0.35 + lines * (pictures + HEAD))
    figure = new_figure(title, WIDTH, height)
    figure.get_layout_engine().set(w_pad=0.03, hspace=0, wspace=0)
    note_below(figure, f"Scores are of the whole frames. {RULE}")
    figure.legend(handles=error_legend(), loc="outside upper right", ncols=2)
    for part, frame in zip(figure.subfigures(len(frames), squeeze=False).flat, frames):
        part.suptitle(frame.caption, x=0.005, ha="left", fontsize=11)
        crops = choose_crops({method: frame.images[method] for method in heads})
        grid = part.add_gridspec(2 * lines, 2 * columns, height_ratios=[2, 1] * lines)
        for i, (method, (name, look)) in enumerate(heads.items()):
            line, column = 2 * (i // columns), 2 * (i % columns)
            image = frame.images[method]
            frame_axes = part.add_subplot(grid[line, column : column + 2], anchor="S")
            frame_picture(frame_axes, "none")
            frame_axes.imshow(image, cmap="gray", vmin=0, vmax=1)
            scores = frame.scores.get(method, {})
            texts = [
                metrics_by_key()[key].score(scores[key], digits)
                for key, digits in SCORES.items()
                if key in scores
            ]
            _write_head(frame_axes, name, look, "   ".join(texts), LETTERS // columns)
            coloured, panel = with_errors(image, frame.images[REFERENCE]), frame_axes
            for k, crop in enumerate(crops):
                _mark(panel, crop)
                panel = part.add_subplot(grid[line + 1, column + k], anchor="N")
                frame_picture(panel, YELLOW, 1.5)
                panel.imshow(crop.of(coloured), extent=crop.extent, interpolation="none")
    return figure


def _mark(axes: Axes, crop: "Window") -> None:
    from matplotlib.patches import Rectangle

    corner = crop.column - 0.5, crop.row - 0.5
    axes.add_patch(Rectangle(corner, crop.width, crop.height, fill=False, color=YELLOW))


def _write_head(axes: Axes, name: str, look: Look, scores: str, letters: int) -> None:
    """Write a method's mark, name and scores above its frame."""
    from matplotlib.transforms import ScaledTranslation

    text = "\n".join(textwrap.fill(part, letters) for part in name.split("\n"))
    style = {"textcoords": "offset points", "annotation_clip": False}
    axes.annotate(scores, (0, 1), xytext=(0, 4), xycoords="axes fraction", fontsize=9, **style)
    axes.set_title(text, loc="left", x=0.06, pad=18, fontsize=10, weight="bold")
    up = ScaledTranslation(0, (22 + 12 * text.count("\n")) / 72, axes.figure.dpi_scale_trans)
    transform = axes.transAxes + up
    style = {"color": look.colour, "markersize": 8, "clip_on": False}
    axes.plot(0.025, 1, marker=look.marker, transform=transform, **style)

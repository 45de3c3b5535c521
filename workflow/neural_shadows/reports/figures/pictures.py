"""Picture strips by method, with crops [figures 4.4–4.7]."""

import textwrap
from collections.abc import Mapping, Sequence
from math import ceil
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from pydantic import Field

from neural_shadows.evaluation.look import YELLOW, Look
from neural_shadows.evaluation.null_predictors import NO_SHADOW
from neural_shadows.evaluation.per_view_metrics import read_metrics
from neural_shadows.layout import tables
from neural_shadows.layout.layout import Layout
from neural_shadows.meshes.mesh_report import read_mesh_report
from neural_shadows.reports.data.chosen_views import RULE, choose_views
from neural_shadows.reports.data.learned import learned_methods, margins
from neural_shadows.reports.data.method_look import LOOKS, REFERENCE, look_of
from neural_shadows.reports.data.published import read_published
from neural_shadows.reports.data.quality import values_by_view
from neural_shadows.reports.drawing.style import new_figure, note_below, write_figure
from neural_shadows.reports.tables import comparison, networks
from neural_shadows.running.stage import run_stage
from neural_shadows.sections.scenes import ViewSet
from neural_shadows.sections.sections import Sections
from neural_shadows.sections.table_figures import MethodsFigure
from neural_shadows.settings.base import check_among
from neural_shadows.settings.records import Row, Run

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, SubFigure
    from matplotlib.gridspec import SubplotSpec

    from neural_shadows.reports.data.frame_errors import Window
    from neural_shadows.reports.data.frames import Frame

MOST_COLUMNS = 4  # of methods in a line; more go to a line of their own
WIDTH = 12.0  # inches, 1800 px: on a page of 1168 px the names are 14 px high
LETTERS = 120  # of the bold names, across the figure
HEAD = 0.6  # inches of a line's names and scores

NOT_LEARNED = "\n(not learned)"  # under the name
SCORES = {"psnr": "PSNR {:.1f} dB", "lpips": "LPIPS {:.4f}"}


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
    rows, scene = settings["rows"], settings["scene"]
    return {
        # No shadow's decide whether a network has learned.
        "metrics": tables.metrics(layout, [*rows, *tables.unshadowed([scene])]),
        "references": tables.references(layout, [scene]),
        "visibilities": tables.visibilities(layout, rows),
        "mesh_json": layout.paths.scene("mesh.json", scene),
        "published_csv": layout.source("config/published.csv"),
    }


def params(layout: Layout, figure: str) -> dict[str, Any]:
    settings = layout.entry("figures", figure)
    return {"rows": settings["rows"], "view_sets": settings["view_sets"], "run": layout.run()}


def draw(
    metrics: list[Path],
    references: list[Path],
    visibilities: list[Path],
    mesh_json: Path,
    published_csv: Path,
    png: Path,
    svg: Path,
    *,
    title: str,
    rows: Sequence[Row],
    view_sets: Sequence[str],
    run: Run,
) -> None:
    """Draw a frame of each view set by every method.

    Args:
        metrics: of all batches of each method and of no shadow.
        references, visibilities: of all batches, see `read_frames`.

    Raises:
        InputError: a file is missing or not frame_axes.
    """
    from neural_shadows.reports.data.frames import read_frames

    measured = dict.fromkeys([NO_SHADOW, *(row["method"] for row in rows)])
    values = read_metrics(metrics)
    by_view = values_by_view(values, [*measured])
    run_margins = margins(read_published(published_csv))
    learned = learned_methods(by_view, rows, run_margins, run["seed"])
    labels = {row["method"]: row["label"] for row in rows}
    labels |= {method: labels[method] + NOT_LEARNED for method in learned if not learned[method]}
    heads = {row["method"]: (labels[row["method"]], look_of(row)) for row in rows}
    chosen = choose_views(values)
    frames = read_frames(references, visibilities, values, [chosen[name] for name in view_sets])
    mesh = read_mesh_report(mesh_json)["name"]
    heading = f"{title} ({mesh}, {run['scale']} scale)"
    write_figure(picture_strip(frames, heads, heading), png, svg)


def picture_strip(
    frames: Sequence["Frame"], heads: Mapping[str, tuple[str, Look]], title: str
) -> "Figure":
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
    pictures = (
        1.5 * WIDTH / columns * rows / across
    )  # a frame_axes frame, and crops of half its width
    height = 1.1 + len(frames) * (0.35 + lines * (pictures + HEAD))
    figure = new_figure(title, WIDTH, height)
    figure.get_layout_engine().set(w_pad=0.03, hspace=0, wspace=0)
    note = textwrap.fill(f"Scores are of the whole frames. {RULE}", 4 * LETTERS // 3)
    note_below(figure, note)
    figure.legend(handles=error_legend(), loc="outside upper right", ncols=2)
    for part, frame in zip(figure.subfigures(len(frames), squeeze=False).flat, frames):
        part.suptitle(frame.caption, x=0.005, ha="left", fontsize=11)
        crops = choose_crops({method: frame.images[method] for method in heads})
        grid = part.add_gridspec(2 * lines, 2 * columns, height_ratios=[2, 1] * lines)
        for i, (method, (name, look)) in enumerate(heads.items()):
            line, column = 2 * (i // columns), 2 * (i % columns)
            image = frame.images[method]
            frame_axes = _panel(part, grid[line, column : column + 2], "S")
            frame_axes.imshow(image, cmap="gray", vmin=0, vmax=1)
            scores = frame.scores.get(method, {})
            texts = [text.format(scores[key]) for key, text in SCORES.items() if key in scores]
            _write_head(frame_axes, name, look, "   ".join(texts), LETTERS // columns)
            coloured, panel = with_errors(image, frame.images[REFERENCE]), frame_axes
            for k, crop in enumerate(crops):
                _mark(panel, crop)
                panel = _panel(part, grid[line + 1, column + k], "N")
                panel.spines[:].set(visible=True, edgecolor=YELLOW, linewidth=1.5)
                panel.imshow(crop.of(coloured), extent=crop.extent, interpolation="none")
    return figure


def _panel(part: "SubFigure", spec: "SubplotSpec", anchor: str) -> "Axes":
    axes = part.add_subplot(spec, xticks=[], yticks=[], anchor=anchor)
    axes.spines[:].set_visible(False)
    return axes


def _mark(axes: "Axes", crop: "Window") -> None:
    from matplotlib.patches import Rectangle

    corner = crop.column - 0.5, crop.row - 0.5
    axes.add_patch(Rectangle(corner, crop.width, crop.height, fill=False, color=YELLOW))


def _write_head(axes: "Axes", name: str, look: Look, scores: str, letters: int) -> None:
    """Write a method's mark, name and scores above its frame."""
    from matplotlib.transforms import ScaledTranslation

    text = "\n".join(textwrap.fill(part, letters) for part in name.split("\n"))
    style = {"textcoords": "offset points", "annotation_clip": False}
    axes.annotate(scores, (0, 1), xytext=(0, 4), xycoords="axes fraction", fontsize=9, **style)
    axes.set_title(text, loc="left", x=0.06, pad=18, fontsize=10, weight="bold")
    up = ScaledTranslation(0, (22 + 12 * text.count("\n")) / 72, axes.figure.dpi_scale_trans)
    transform = axes.transAxes + up
    axes.plot(0.025, 1, look.marker, color=look.colour, ms=8, transform=transform, clip_on=False)


if "snakemake" in globals():
    run_stage(snakemake, draw)

"""Picture strips: viewpoints as every method renders them, with crops [figures 4.4 to 4.7]."""

import textwrap
from collections.abc import Mapping, Sequence
from math import ceil
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from numpy.lib.stride_tricks import sliding_window_view
from scipy.ndimage import maximum_filter, minimum_filter

from neural_shadows.evaluation.method_names import NO_SHADOW
from neural_shadows.evaluation.per_view_metrics import read_metrics
from neural_shadows.meshes.mesh_report import read_mesh_report
from neural_shadows.reports.chosen_views import choose_views
from neural_shadows.reports.figures.style import ORANGE, Section, new_figure, write_figure
from neural_shadows.reports.frames import Frame, read_frames
from neural_shadows.reports.learned import learned_methods, margins
from neural_shadows.reports.published import read_published
from neural_shadows.reports.tables.quality import values_by_view
from neural_shadows.running.stage import run_stage

# Grey levels in [0, 1]. Light and shadow differ by 0.75 n.l, neighbouring facets by far less;
# a step of an 8-bit picture is 0.004.
BORDER_STEP = 0.1
VISIBLE_DIFFERENCE = 0.05
CROP_SHARE = 0.2  # of the frame's height and width

MOST_COLUMNS = 6  # of methods in a line; more go to a line of their own
WIDTH = 13.6  # inches, 2040 px
LETTERS = 160  # of the bold names, across the figure
TEXT = 0.9  # inches of a line's names and scores

NOT_LEARNED = "\n(not learned)"  # under the name
SCORES = {"psnr": "PSNR {:.2f} dB", "lpips": "LPIPS {:.4f}"}


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
    rows: Sequence[Section],
    view_sets: Sequence[str],
    run: Section,
) -> None:
    """Draw a frame of each view set by every method, whole and as a crop.

    Args:
        metrics: of all batches of each method and of no shadow.
        references, visibilities: of all batches, see `read_frames`.

    Raises:
        InputError: a file is missing or not whole.
    """
    measured = dict.fromkeys([NO_SHADOW, *(row["method"] for row in rows)])
    values = read_metrics(metrics)
    wide = values_by_view(values, [*measured])
    chance = margins(read_published(published_csv))
    found = learned_methods(wide, rows, chance, run["seed"])
    labels = {row["method"]: row["label"] for row in rows} | {"reference": "Reference"}
    labels |= {method: labels[method] + NOT_LEARNED for method in found if not found[method]}
    chosen = choose_views(values)
    views = [chosen[view_set] for view_set in view_sets]
    frames = read_frames(references, visibilities, values, views)
    mesh = read_mesh_report(mesh_json)["name"]
    heading = f"{title} ({mesh}, {run['scale']} scale)"
    write_figure(picture_strip(frames, labels, heading), png, svg)


def choose_crop(frames: Mapping[str, np.ndarray]) -> tuple[int, int, int, int]:
    """The window that shows best how methods differ at shadow borders of the reference.

    Args:
        frames: greyscale images, shape (H, W), in [0, 1], of the methods and of `reference`.

    Returns:
        (row, column, height, width) in pixels: a fifth of the frame either way. In it lie the
        most pixels at a brightness step of the reference that a method renders otherwise, each
        counted once a method. Of equally good windows the middle one.
    """
    reference = frames["reference"]
    step = maximum_filter(reference, 3) - minimum_filter(reference, 3)
    others = [frame for method, frame in frames.items() if method != "reference"]
    wrong = sum(np.abs(frame - reference) > VISIBLE_DIFFERENCE for frame in others)
    interest = np.where(step > BORDER_STEP, wrong, 0)

    height, width = (max(1, round(CROP_SHARE * size)) for size in reference.shape)
    inside = sliding_window_view(interest, height, axis=0).sum(axis=-1)
    inside = sliding_window_view(inside, width, axis=1).sum(axis=-1)
    best = np.argwhere(inside == inside.max())
    row, column = best[np.argmin(((best - best.mean(axis=0)) ** 2).sum(axis=1))]
    return int(row), int(column), height, width


def picture_strip(frames: Sequence[Frame], labels: Mapping[str, str], title: str) -> Figure:
    """Draw a row of whole frames and a row of crops for each viewpoint.

    Args:
        frames: viewpoints whose images have one shape and hold `reference`, which is drawn last,
            as in the thesis. Scores that a viewpoint has are written below its crops.
        labels: the name of each method to draw, in the order to draw them, and of `reference`.
    """
    methods = [*(method for method in labels if method != "reference"), "reference"]
    lines = ceil(len(methods) / MOST_COLUMNS)
    columns = ceil(len(methods) / lines)
    rows, across = frames[0].images["reference"].shape
    height = 0.7 + len(frames) * (0.3 + lines * (2 * WIDTH / columns * rows / across + TEXT))
    figure = new_figure(title, WIDTH, height)
    figure.get_layout_engine().set(w_pad=0.03, hspace=0, wspace=0)
    figure.supxlabel("Scores are of the whole frames.", x=0.005, ha="left", fontsize=10)
    for part, frame in zip(figure.subfigures(len(frames), squeeze=False).flat, frames):
        part.suptitle(frame.caption, x=0.005, ha="left", fontsize=11)
        images = {m: frame.images[m] for m in methods}
        row, column, crop_rows, crop_columns = choose_crop(images)
        panels = part.subplots(2 * lines, columns, squeeze=False)
        for i, axes in enumerate(panels.flat):
            axes.set(xticks=[], yticks=[], anchor="NS"[i // columns % 2 == 0])
            axes.spines[:].set_visible(False)
        for j, method in enumerate(methods):
            whole, crop = panels[2 * (j // columns) :, j % columns][:2]
            # Names must not run together.
            heads = labels[method].split("\n")
            name = "\n".join(textwrap.fill(head, LETTERS // columns) for head in heads)
            whole.set_title(name, fontsize=10, weight="bold")
            style = {"cmap": "gray", "vmin": 0, "vmax": 1}
            whole.imshow(images[method], **style)
            corner = column - 0.5, row - 0.5
            whole.add_patch(Rectangle(corner, crop_columns, crop_rows, fill=False, color=ORANGE))
            part_of = images[method][row : row + crop_rows, column : column + crop_columns]
            crop.imshow(part_of, interpolation="nearest", **style)
            crop.spines[:].set(visible=True, edgecolor=ORANGE, linewidth=1.2)
            found = frame.scores.get(method, {})
            texts = [text.format(found[key]) for key, text in SCORES.items() if key in found]
            crop.set_xlabel("\n".join(texts))
    return figure


if "snakemake" in globals():
    run_stage(snakemake, draw)

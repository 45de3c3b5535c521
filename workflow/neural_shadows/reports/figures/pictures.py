"""Picture strips: viewpoints as every method renders them, with crops [figures 4.4 to 4.7]."""

import textwrap
from collections.abc import Mapping, Sequence
from math import ceil
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from numpy.lib.stride_tricks import sliding_window_view
from scipy.ndimage import maximum_filter, minimum_filter

from neural_shadows.evaluation.first_frames import FirstFrame, read_first_frames
from neural_shadows.meshes.mesh_report import read_mesh_report
from neural_shadows.reports.figures.style import DPI, ORANGE, write_figure
from neural_shadows.running.stage import run_stage
from neural_shadows.scenes.cameras import VIEW_SETS

# Grey levels in [0, 1]. Light and shadow differ by 0.75 n.l, neighbouring facets by far less;
# a step of an 8-bit picture is 0.004.
BORDER_STEP = 0.1
VISIBLE_DIFFERENCE = 0.05
CROP_SHARE = 0.2  # of the frame's height and width

MOST_COLUMNS = 6  # of methods in a line; more go to a line of their own
WIDTH = 13.6  # inches, 2040 px
GAP = 0.06  # inches between pictures
LINE = 0.2  # inches, a line of text
FONT_SIZE = 10

SCORES = {"psnr": "PSNR {:.2f} dB", "lpips": "LPIPS {:.4f}"}


def draw(
    metrics: list[Path],
    pictures: list[Path],
    mesh_json: Path,
    png: Path,
    svg: Path,
    *,
    title: str,
    rows: Sequence[Mapping[str, Any]],
    view_sets: Sequence[str],
    run: Mapping[str, Any],
) -> None:
    """Draw the first frame of each view set by every method, whole and as a crop.

    Args:
        metrics: of each method's first batch.
        pictures: of the same batches, and the reference's.

    Raises:
        InputError: a file is missing or not whole.
    """
    labels = {row["method"]: row["label"] for row in rows} | {"reference": "Reference"}
    captions = [VIEW_SETS[view_set] for view_set in view_sets]
    frames = [f for f in read_first_frames(pictures, metrics) if f.caption in captions]
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


def picture_strip(frames: Sequence[FirstFrame], labels: Mapping[str, str], title: str) -> Figure:
    """Draw a row of whole frames and a row of crops for each viewpoint.

    Args:
        frames: viewpoints whose images have one shape and hold `reference`, which is drawn last,
            as in the thesis. Scores that all of a viewpoint have are written below its crops.
        labels: the name of each method to draw, in the order to draw them, and of `reference`.
    """
    methods = [*(method for method in labels if method != "reference"), "reference"]
    columns = ceil(len(methods) / ceil(len(methods) / MOST_COLUMNS))
    rows, across = frames[0].images["reference"].shape
    width = (WIDTH - GAP * (columns + 1)) / columns
    height = width * rows / across
    # A letter of the bold default font is about 0.6 of its size wide: names must not run together.
    letters = int(72 * width / (0.6 * FONT_SIZE))
    names = {method: textwrap.fill(labels[method], letters) for method in methods}
    name_height = LINE * (1 + max(name.count("\n") for name in names.values()))
    scores = [key for key in SCORES if any(key in s for s in frames[0].scores.values())]
    # Of a line of methods: names, frames, crops, scores and a free line.
    line_height = name_height + 2 * height + GAP + LINE * (len(scores) + 1)
    block = 1.4 * LINE + ceil(len(methods) / columns) * line_height
    total = 2 * LINE + len(frames) * block + (LINE if scores else 0)
    figure = Figure(figsize=(WIDTH, total), dpi=DPI)

    def write(left: float, top: float, text: str, **style) -> None:
        figure.text(left / WIDTH, 1 - top / total, text, **{"va": "center"} | style)

    def show(left: float, top: float, image: np.ndarray, interpolation: str) -> Axes:
        box = left / WIDTH, 1 - (top + height) / total, width / WIDTH, height / total
        axes = figure.add_axes(box, xticks=[], yticks=[])
        axes.imshow(image, cmap="gray", vmin=0, vmax=1, interpolation=interpolation, aspect="auto")
        return axes

    write(GAP, LINE, title, fontsize=FONT_SIZE + 3, weight="bold")
    for i, frame in enumerate(frames):
        start = 2 * LINE + i * block
        write(GAP, start + 0.6 * LINE, frame.caption, fontsize=FONT_SIZE + 1)
        images = {m: frame.images[m].astype(np.float32) / 255 for m in methods}
        row, column, crop_rows, crop_columns = choose_crop(images)
        for j, method in enumerate(methods):
            left = GAP + j % columns * (width + GAP)
            top = start + 1.4 * LINE + j // columns * line_height + name_height
            middle = {"ha": "center", "fontsize": FONT_SIZE}
            style = {"weight": "bold", "va": "bottom", "linespacing": 1.0} | middle
            write(left + width / 2, top - 0.2 * LINE, names[method], **style)
            axes = show(left, top, images[method], "auto")
            axes.spines[:].set_visible(False)
            style = {"fill": False, "edgecolor": ORANGE, "linewidth": 1.2}
            corner = column - 0.5, row - 0.5
            axes.add_patch(Rectangle(corner, crop_columns, crop_rows, **style))
            part = images[method][row : row + crop_rows, column : column + crop_columns]
            axes = show(left, top + height + GAP, part, "nearest")
            axes.spines[:].set(edgecolor=ORANGE, linewidth=1.2)
            below = top + 2 * height + GAP + 0.7 * LINE
            found = frame.scores.get(method, {})
            for k, key in enumerate(key for key in scores if key in found):
                text = SCORES[key].format(found[key])
                write(left + width / 2, below + k * LINE, text, **middle)
    if scores:
        write(GAP, total - 0.7 * LINE, "Scores are of the whole frames.", fontsize=FONT_SIZE)
    return figure


if "snakemake" in globals():
    run_stage(snakemake, draw)

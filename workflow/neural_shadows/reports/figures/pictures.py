"""Picture strips: viewpoints as every method renders them, with crops [figures 4.4 to 4.7]."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from scipy.ndimage import maximum_filter, minimum_filter
from skimage.transform import integral_image

from neural_shadows.evaluation.first_frames import read_first_frames
from neural_shadows.meshes.mesh_report import read_mesh_report
from neural_shadows.reports.figures.style import DPI, write_strip

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# Grey levels in [0, 1]. Light and shadow differ by 0.75 n.l, neighbouring facets by far less;
# a step of an 8-bit picture is 0.004.
BORDER_STEP = 0.1
VISIBLE_DIFFERENCE = 0.05
CROP_SHARE = 0.2  # of the frame's height and width

WIDTH = 13.6  # inches, 2040 px
GAP = 0.06  # inches between pictures
LINE = 0.2  # inches, a line of text
FONT_SIZE = 10
CROP_COLOUR = "#e4572e"

SCORES = {"psnr": "PSNR {:.2f} dB", "lpips": "LPIPS {:.4f}"}


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
    interest = np.where(step > BORDER_STEP, wrong, 0).astype(np.int64)

    height, width = (max(1, round(CROP_SHARE * size)) for size in reference.shape)
    total = np.pad(integral_image(interest), ((1, 0), (1, 0)))
    inside = (
        total[height:, width:]
        - total[:-height, width:]
        - total[height:, :-width]
        + total[:-height, :-width]
    )
    best = np.argwhere(inside == inside.max())
    row, column = best[np.argmin(((best - best.mean(axis=0)) ** 2).sum(axis=1))]
    return int(row), int(column), height, width


def picture_strip(
    frames: Sequence[Mapping[str, np.ndarray]],
    labels: Mapping[str, str],
    captions: Sequence[str],
    *,
    title: str,
    scores: Sequence[Mapping[str, Mapping[str, float]]] | None = None,
) -> Figure:
    """Draw a row of whole frames and a row of crops for each viewpoint.

    Args:
        frames: per viewpoint, greyscale images of shape (H, W) in [0, 1] by method, all of one
            shape. `reference` is drawn last, as in the thesis.
        labels: the name of each method to draw, in the order to draw them, and of `reference`.
        captions: what each viewpoint shows.
        title: scene, mesh and scale.
        scores: per viewpoint and method, `psnr` (dB) and `lpips` of the whole frame; either
            may be absent throughout. Written below the crops.
    """
    from matplotlib.figure import Figure
    from matplotlib.patches import Rectangle

    methods = [*(method for method in labels if method != "reference"), "reference"]
    rows, columns = frames[0]["reference"].shape
    width = (WIDTH - GAP * (len(methods) + 1)) / len(methods)
    height = width * rows / columns
    named = [name for name in SCORES if scores and any(name in s for s in scores[0].values())]
    # Above the pictures a caption and the methods' names, below them scores and a free line.
    block_height = 2.4 * LINE + 2 * height + GAP + (len(named) + 1) * LINE
    total_height = 2 * LINE + len(frames) * block_height + (LINE if named else 0)
    figure = Figure(figsize=(WIDTH, total_height), dpi=DPI)
    # A letter of the bold default font is about 0.6 of its size wide: names must not run together.
    longest = max(len(labels[method]) for method in methods)
    name_size = min(FONT_SIZE, 72 * width / (0.6 * longest))
    lefts = [GAP + i * (width + GAP) for i in range(len(methods))]

    def write(left: float, top: float, text: str, **style) -> None:
        style = {"fontsize": FONT_SIZE, "va": "center"} | style
        figure.text(left / WIDTH, 1 - top / total_height, text, **style)

    def show(left: float, top: float, image: np.ndarray, interpolation: str) -> Axes:
        axes = figure.add_axes(
            (
                left / WIDTH,
                1 - (top + height) / total_height,
                width / WIDTH,
                height / total_height,
            ),
            xticks=[],
            yticks=[],
        )
        axes.imshow(image, cmap="gray", vmin=0, vmax=1, interpolation=interpolation, aspect="auto")
        return axes

    write(GAP, LINE, title, fontsize=FONT_SIZE + 3, weight="bold")
    for i, (views, caption) in enumerate(zip(frames, captions, strict=True)):
        top = 2 * LINE + i * block_height
        write(GAP, top + 0.6 * LINE, caption, fontsize=FONT_SIZE + 1)
        frame_top = top + 2.4 * LINE
        crop_top = frame_top + height + GAP
        shown = {method: views[method] for method in methods}
        row, column, crop_rows, crop_columns = choose_crop(shown)
        for method, left in zip(methods, lefts, strict=True):
            middle = left + width / 2
            write(
                middle,
                frame_top - 0.5 * LINE,
                labels[method],
                ha="center",
                weight="bold",
                fontsize=name_size,
            )
            frame = shown[method]
            axes = show(left, frame_top, frame, "auto")
            axes.spines[:].set_visible(False)
            axes.add_patch(
                Rectangle(
                    (column - 0.5, row - 0.5),
                    crop_columns,
                    crop_rows,
                    fill=False,
                    edgecolor=CROP_COLOUR,
                    linewidth=1.2,
                )
            )
            crop = frame[row : row + crop_rows, column : column + crop_columns]
            axes = show(left, crop_top, crop, "nearest")
            axes.spines[:].set(edgecolor=CROP_COLOUR, linewidth=1.2)
            for j, name in enumerate(named):
                if method in scores[i]:
                    score = SCORES[name].format(scores[i][method][name])
                    write(middle, crop_top + height + (j + 0.7) * LINE, score, ha="center")
    if named:
        write(GAP, total_height - 0.7 * LINE, "Scores are of the whole frames.")
    return figure


def write_picture_strip(
    pictures: Sequence[Path],
    metrics: Sequence[Path],
    mesh_json: Path,
    png: Path,
    svg: Path,
    *,
    title: str,
    rows: Sequence[Mapping[str, str | None]],
    scale: str,
) -> None:
    """Draw the first frame of each view set by every method, whole and as a crop.

    Args:
        pictures: frames as `evaluate` wrote them, one file for each evaluation and view set.
        metrics: the metrics of the same batches, in the same order.
    """
    labels = {row["method"]: row["label"] for row in rows} | {"reference": "Reference"}
    frames = read_first_frames(pictures, metrics)
    shown = [
        {key: image.astype(np.float32) / 255 for key, image in frame.images.items()}
        for frame in frames
    ]
    mesh = read_mesh_report(mesh_json)["name"]
    figure = picture_strip(
        shown,
        labels,
        [frame.caption for frame in frames],
        title=f"{title} ({mesh}, {scale} scale)",
        scores=[frame.scores for frame in frames],
    )
    write_strip(figure, png, svg)

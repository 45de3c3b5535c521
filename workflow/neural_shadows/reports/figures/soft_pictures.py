"""A frame by methods for soft shadows, with their errors."""

import sys
import textwrap
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, ClassVar, Literal

import numpy as np
from pydantic import Field

from neural_shadows.evaluation.answers import name_of, read_answer
from neural_shadows.evaluation.look import FALSE_SHADOW, LIGHT_LEAK
from neural_shadows.frames.light_size import shown_radii
from neural_shadows.layout import frame_sets, kinds
from neural_shadows.layout.layout import Layout
from neural_shadows.layout.tables import frame_set, unique
from neural_shadows.metrics.registry import metrics
from neural_shadows.reports.data.lights import light_names
from neural_shadows.reports.drawing.style import (
    Axes,
    Figure,
    frame_picture,
    new_figure,
    note_below,
    run_figure,
)
from neural_shadows.reports.tables import soft_methods, soft_summary
from neural_shadows.sections.any_report import Chapter
from neural_shadows.sections.frame_sets import measured_scenes
from neural_shadows.sections.sections import Sections
from neural_shadows.sections.table_figures import RadiiFigure
from neural_shadows.settings.base import check_among, name_in
from neural_shadows.settings.records import Run

NUMBER = 0  # of the shown frame in its part
WIDTH, NARROWEST = 12.0, 5.2  # inches
WIDEST, HIGHEST = 4.0, 2.4  # of a picture
MARGIN = 0.5  # of the methods' names
NOTE = (
    "Visibility, and its errors: orange is too dark (false shadow), blue too bright (light leak), "
    "white none; errors from half of the light on have the full colour."
)


class Settings(RadiiFigure):
    """A frame by methods for soft shadows, with their errors.

    At several radii; the page compares any two of them.
    """

    tables = (soft_methods.Settings, soft_summary.Settings)
    chapter: ClassVar[Chapter] = "soft"

    kind: Literal["soft_pictures"] = Field(description="`soft_pictures`")
    scene: name_in("scenes") = Field(description="its first test frame is shown")
    methods: list[str] = Field(min_length=1, description="methods of the table")
    radii: list[int] | None = Field(
        None,
        min_length=1,
        description="numbers of radii, counted from 0; by default the least but a point light, the "
        "middle and the largest",
    )

    def check(self, config: Sections, key: str) -> None:
        super().check(config, key)
        table = config.tables[self.table]
        scenes = measured_scenes(config.frame_sets[table.frame_set])
        check_among(f"{key}.scene", self.scene, scenes)
        for method in self.methods:
            check_among(f"{key}.methods", method, table.methods_shown())

    def resolved(self, config: Sections) -> dict[str, Any]:
        frames = config.frame_sets[config.tables[self.table].frame_set]
        return self.model_dump() | {"radii": self.radii or shown_radii(len(frames.radii))}


def files(layout: Layout, figure: str) -> dict[str, Any]:
    settings = layout.entry("figures", figure)
    frames = frame_set(layout, settings["table"])
    return {"part": frame_sets.parts(layout, settings["scene"], frames, "test")[0]}


def shown(layout: Layout) -> list[dict[str, Any]]:
    """The frames of this kind's figures, for `soft_comparisons`."""
    frames = []
    for name in _of_this_kind(layout, layout.settings["figures"]):
        settings = layout.entry("figures", name)
        table = settings["table"]
        frames.append(
            {
                "table": table,
                "title": layout.entry("tables", table)["title"],
                "frame_set": frame_set(layout, table),
                "scene": settings["scene"],
                "labels": kinds.params(layout, "figures", name)["labels"],
                "radii": settings["radii"],
            }
        )
    return frames


def shown_files(layout: Layout, figures: Iterable[str]) -> dict[str, list[str]]:
    """The files of this kind's figures, each once."""
    inputs = [kinds.files(layout, "figures", name) for name in _of_this_kind(layout, figures)]
    return {
        "soft_parts": unique(paths["part"] for paths in inputs),
        "soft_answers": unique(path for paths in inputs for path in paths["soft_answers"]),
    }


def _of_this_kind(layout: Layout, figures: Iterable[str]) -> list[str]:
    this = sys.modules[__name__]
    return [name for name in figures if kinds.kind_of(layout, "figures", name) is this]


def draw(
    part: Path,
    soft_answers: list[Path],
    title: str,
    labels: Mapping[str, str],
    radii: Sequence[int],
    run: Run,
) -> Figure:
    """Draw a part's first frame by each method and radius.

    Args:
        part: of a frame set, see `FrameSetPart`; soft_answers: of each method, by file name.
        labels: of the methods, in the order to draw them; radii: their numbers, counted from 0.
    """
    from neural_shadows.frames.frame_set import FrameSetPart

    opened = FrameSetPart(part)
    targets = opened.targets[NUMBER].astype(np.float32)
    valid = np.asarray(opened.valid[NUMBER, 0])
    paths = {path.stem: path for path in soft_answers}
    pictures = {
        label: [read_answer(paths[method], name_of(part, k)) for k in radii]
        for method, label in labels.items()
    }
    lights = [light_names(opened.about)[k] for k in radii]
    heading = f"{title} ({part.parent.name}, {run['scale']} scale)"
    return strips(pictures, [targets[k] for k in radii], valid, lights, heading)


def strips(
    pictures: Mapping[str, Sequence[np.ndarray]],
    targets: Sequence[np.ndarray],
    valid: np.ndarray,
    lights: Sequence[str],
    title: str,
) -> Figure:
    """Draw exact soft shadows, and below each method's, with errors.

    Args:
        pictures: (H, W) in [0, 1] of each method, by light; valid: (H, W) bool, the evaluated
            pixels.
        lights: their sizes in words.
    """
    labels, columns = ["Exact", *pictures], 2 * len(targets)
    figure, grid = _grid(title, labels, columns, valid.shape, NOTE)
    for k, (target, light) in enumerate(zip(targets, lights)):
        _show(grid[0, 2 * k], target, light)
        grid[0, 2 * k + 1].set_axis_off()
        for axes, images in zip(grid[1:], pictures.values()):
            error = np.where(valid, images[k] - target, 0)
            square = np.square(error[valid]).mean()
            _show(axes[2 * k], images[k], light)
            _show(axes[2 * k + 1], coloured(error), f"error, {metrics()['mse'].score(square)}")
    return figure


def answers_alone(
    pictures: Mapping[str, Sequence[np.ndarray]], lights: Sequence[str], title: str
) -> Figure:
    """Draw each method's visibility by radius, without a reference.

    Args:
        pictures, lights: see `strips`.
    """
    shape = next(iter(pictures.values()))[0].shape
    figure, grid = _grid(title, [*pictures], len(lights), shape)
    for row, images in zip(grid, pictures.values()):
        for axes, picture, light in zip(row, images, lights):
            _show(axes, picture, light)
    return figure


def _grid(
    title: str, labels: Sequence[str], columns: int, shape: tuple[int, int], note: str = ""
) -> tuple[Figure, np.ndarray]:
    """A figure with a row of pictures a label, and its axes.

    Args:
        shape: a picture's height and width.
    """
    height, width = shape
    side = min((WIDTH - MARGIN) / columns, WIDEST, HIGHEST * width / height)
    tall = side * height / width
    across = max(MARGIN + columns * side, NARROWEST)
    figure = new_figure(title, across, (1.3 if note else 0.6) + len(labels) * (tall + 0.25))
    figure.get_layout_engine().set(w_pad=0.02, h_pad=0.02, hspace=0, wspace=0)
    grid = figure.subplots(len(labels), columns, squeeze=False)
    for axes, label in zip(grid[:, 0], labels):
        axes.set_ylabel(textwrap.fill(label, max(10, int(14 * tall))), fontsize=9)
    if note:
        note_below(figure, note)
    return figure, grid


def coloured(error: np.ndarray) -> np.ndarray:
    """Colours (H, W, 3) of errors (H, W)."""
    from matplotlib.colors import to_rgb

    from neural_shadows.reports.data.frame_errors import FULL

    share = np.clip(np.abs(error) / FULL, 0, 1)[..., None]
    colour = np.where(error[..., None] < 0, to_rgb(FALSE_SHADOW), to_rgb(LIGHT_LEAK))
    return 1 - share * (1 - colour)  # orange below 0, blue above, white at 0


def _show(axes: Axes, image: np.ndarray, text: str) -> None:
    # Of a larger frame not every n-th pixel.
    axes.imshow(image, cmap="gray", vmin=0, vmax=1, interpolation="antialiased")
    frame_picture(axes)  # much of most pictures is white
    axes.set_title(text, loc="left", fontsize=8, pad=2)


if "snakemake" in globals():
    run_figure(snakemake, draw)

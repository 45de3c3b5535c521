"""Flicker of methods [Datta et al. 2022, figures 5, 6]."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Literal

import numpy as np
from pydantic import Field

from neural_shadows.evaluation.answers import flicker_name, read_answer
from neural_shadows.frames.uses import use_of
from neural_shadows.reports.drawing.style import Figure, new_figure, note_below
from neural_shadows.reports.tables import screen_temporal
from neural_shadows.sections.sections import Sections
from neural_shadows.sections.table_figures import TableFigure
from neural_shadows.settings.base import check_among

# As in the paper: purple is stable, gold flickers.
COLOURS = ["#2d0b59", "#8c2981", "#e69f00", "#fff7bc"]
FULL = 0.1  # mean change of visibility from frame to frame at the end of the colour map
WIDTH = 12.0  # inches


class Settings(TableFigure):
    """The flicker of methods in a frame set's sequences."""

    tables = (screen_temporal.Settings,)
    kind: Literal["screen_flicker"] = Field(description="`screen_flicker`")
    methods: list[str] = Field(min_length=1, description="methods of the table")

    def check(self, config: Sections, key: str) -> None:
        super().check(config, key)
        for method in self.methods:
            check_among(f"{key}.methods", method, config.tables[self.table].methods_shown())


def draw(
    sequences: list[Path], soft_answers: list[Path], heading: str, labels: Mapping[str, str]
) -> Figure:
    """Draw flicker by method, exact shadows first, and sequence of the first scene.

    Args:
        sequences: parts of a frame set; soft_answers: of each method, by file name.
        labels: of the methods, in the order to draw them.
    """
    sequences = [part for part in sequences if part.parent == sequences[0].parent]
    paths = {path.stem: path for path in soft_answers}
    first = next(iter(paths.values()))
    maps = {"exact": [read_answer(first, flicker_name(part, exact=True)) for part in sequences]}
    for method, label in labels.items():
        maps[label] = [read_answer(paths[method], flicker_name(part)) for part in sequences]
    moving = [use_of(part.stem) for part in sequences]
    return flicker_figure(maps, moving, heading)


def flicker_figure(
    maps: Mapping[str, Sequence[np.ndarray]], moving: Sequence[str], title: str
) -> Figure:
    """Draw maps of flicker by method and sequence.

    Args:
        maps: (H, W) in [0, 1], mean change from frame to frame.
        moving: the moving part of each sequence.
    """
    from matplotlib.colors import LinearSegmentedColormap

    colours = LinearSegmentedColormap.from_list("flicker", COLOURS)
    height, width = next(iter(maps.values()))[0].shape
    inches = WIDTH / len(moving) * height / width + 0.2
    figure = new_figure(title, WIDTH, 1.2 + len(maps) * inches)
    figure.get_layout_engine().set(w_pad=0.02, h_pad=0.02, hspace=0, wspace=0)
    grid = figure.subplots(len(maps), len(moving), squeeze=False)
    for line, (label, images) in enumerate(maps.items()):
        for axes, image, mover in zip(grid[line], images, moving):
            axes.set_axis_off()
            shown = axes.imshow(image, cmap=colours, vmin=0, vmax=FULL, interpolation="none")
            axes.set_title(f"{label}, {mover} moves: {image.mean():.4f}", loc="left", fontsize=8)
    figure.colorbar(shown, ax=grid, location="bottom", shrink=0.4, aspect=40, extend="max")
    note_below(
        figure,
        "Mean change of visibility from frame to frame along each point's motion, drawn at the "
        "point's pixel\nin the later frame. Purple is stable, gold flickers; numbers are means.",
    )
    return figure

"""One frame by methods for soft shadows, with their errors, at several radii."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from neural_shadows.evaluation.soft_answers import name_of, read_answer
from neural_shadows.frames.frame_set import FrameSetPart
from neural_shadows.reports.figures.style import Section, new_figure, note_below, write_figure
from neural_shadows.reports.frame_errors import FULL
from neural_shadows.reports.soft_looks import light_names
from neural_shadows.running.stage import run_stage

NUMBER = 0  # of the part's frames, the one that is shown
WIDTH = 12.0  # inches
WIDEST = 4.0  # of a picture


def draw(
    part: Path,
    answers: list[Path],
    png: Path,
    svg: Path,
    *,
    title: str,
    labels: Mapping[str, str],
    radii: Sequence[int],
    run: Section,
) -> None:
    """Draw the first frame of a part: a line a method, two pictures for each radius.

    Args:
        part: of a frame set, see `FrameSetPart`; answers: of each method, by file name.
        labels: of the methods, in the order to draw them; radii: which, counted from 0.

    Raises:
        InputError: a file is missing or not whole.
    """
    opened = FrameSetPart(part)
    targets = opened.targets[NUMBER].astype(np.float32)
    valid = np.asarray(opened.valid[NUMBER, 0])
    files = {path.stem: path for path in answers}
    pictures = {
        label: [read_answer(files[method], name_of(part, k)) for k in radii]
        for method, label in labels.items()
    }
    lights = [light_names(opened.about)[k] for k in radii]
    heading = f"{title} ({part.parent.name}, {run['scale']} scale)"
    figure = strips(pictures, [targets[k] for k in radii], valid, lights, heading)
    write_figure(figure, png, svg)


def strips(
    pictures: Mapping[str, Sequence[np.ndarray]],
    targets: Sequence[np.ndarray],
    valid: np.ndarray,
    lights: Sequence[str],
    title: str,
) -> Figure:
    """The exact soft shadow of each light, and below it each method's with its error.

    Args:
        pictures: (H, W) in [0, 1] of each method, by light; valid: (H, W) bool, what counts.
        lights: how large each is, in words.
    """
    rows, columns = 1 + len(pictures), 2 * len(targets)
    height, width = valid.shape
    figure, grid = _grid(title, rows, columns, height / width, note=0.5)
    for k, (target, light) in enumerate(zip(targets, lights)):
        _show(grid[0, 2 * k], target, f"exact, {light}")
        _show(grid[0, 2 * k + 1], None, "")
        for line, (label, found) in enumerate(pictures.items(), 1):
            error = np.where(valid, found[k] - target, 0)
            square = np.square(error[valid]).mean()
            _show(grid[line, 2 * k], found[k], label)
            _show(grid[line, 2 * k + 1], coloured(error), f"MSE {1e4 * square:.1f} × 10⁻⁴")
    note_below(
        figure,
        "Errors: orange is too dark (false shadow), blue too bright (light leak), white none; half "
        "of the light and more has the whole colour.",
    )
    return figure


def answers_alone(
    pictures: Mapping[str, Sequence[np.ndarray]], lights: Sequence[str], title: str
) -> Figure:
    """What each method answered for each radius, where nothing is known to compare with.

    Args:
        pictures, lights: as of `strips`.
    """
    height, width = next(iter(pictures.values()))[0].shape
    figure, grid = _grid(title, len(pictures), len(lights), height / width)
    for number, (label, found) in enumerate(pictures.items()):
        for axes, picture, light in zip(grid[number], found, lights):
            _show(axes, picture, label if number else f"{light}: {label}")
    return figure


def _grid(
    title: str, rows: int, columns: int, shape: float, note: float = 0.0
) -> tuple[Figure, np.ndarray]:
    """A figure of so many pictures, and its axes.

    Args:
        shape: a picture's height over its width. note: inches for a note below.
    """
    side = min(WIDTH / columns, WIDEST)
    figure = new_figure(
        title, max(columns * side, 2 * WIDEST), 0.6 + note + rows * (side * shape + 0.2)
    )
    figure.get_layout_engine().set(w_pad=0.02, h_pad=0.02, hspace=0, wspace=0)
    return figure, figure.subplots(rows, columns, squeeze=False)


def coloured(error: np.ndarray) -> np.ndarray:
    """Errors (H, W) as colours (H, W, 3): orange below 0, blue above, white at 0."""
    from matplotlib.colors import to_rgb

    from neural_shadows.reports.figures.style import FALSE_SHADOW, LIGHT_LEAK

    share = np.clip(np.abs(error) / FULL, 0, 1)[..., None]
    colour = np.where(error[..., None] < 0, to_rgb(FALSE_SHADOW), to_rgb(LIGHT_LEAK))
    return 1 - share * (1 - colour)


def _show(axes: Axes, image: np.ndarray | None, text: str) -> None:
    axes.set_axis_off()
    if image is not None:
        axes.imshow(image, cmap="gray", vmin=0, vmax=1, interpolation="none")
    axes.set_title(text, loc="left", fontsize=8, pad=2)


if "snakemake" in globals():
    run_stage(snakemake, draw)

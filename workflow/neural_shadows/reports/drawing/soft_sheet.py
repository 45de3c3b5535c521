"""Soft shadows of a frame by methods and lights, with errors.

All places are in inches from the figure's upper left corner, so that a crop's pixels keep their size.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from textwrap import TextWrapper

import numpy as np

from neural_shadows.evaluation.look import GREEN, PINK
from neural_shadows.metrics.registry import metrics
from neural_shadows.reports.data.frame_errors import FULL, Window, choose_boxes, coloured
from neural_shadows.reports.data.soft_pictures import SoftPictures
from neural_shadows.reports.drawing.style import (
    DPI,
    TITLE_LETTERS,
    Axes,
    Figure,
    frame_picture,
)

WIDTH, NARROWEST = 12.0, 7.5
EDGE = 0.12  # round the figure
MARGIN = 0.45  # of the lights' names
GAP, WIDE_GAP = 0.04, 0.14  # between pictures, and between methods or lights
LINE, TITLE_LINE = 0.165, 0.25  # of text of 9 points, of the title
LETTERS = 12.5  # of 9 points, an inch
SCALE = 0.55  # height of the errors' scale
OVERVIEW, BESIDE = 7.0, 3.2  # width of the scene's picture, and least width of the text beside it
WIDEST_CROP, WIDEST_WHOLE, HIGHEST_WHOLE = 1.15, 4.0, 2.4
MOST_BESIDE = 6  # columns with both boxes side by side
ZOOM, ASPECT = 4, 1.5  # of a crop: pixels of the PNG along a pixel, width over height
BOXES = {"a": GREEN, "b": PINK}  # no colours of errors
FRAME = "#999999"
ABOUT_ERRORS = (
    "Below each method’s picture is its error in visibility, below the exact one the visibility. Numbers: "
    "mean squared error × 10⁻⁴ of the whole frame."
)


def crop_sheet(pictures: SoftPictures, labels: Mapping[str, str], title: str, scene: str) -> Figure:
    """Draw a scene with two boxes, and both by method and light.

    The boxes have most of the methods' errors, see `choose_boxes`.

    Args:
        labels: of the methods, in the order to draw them. scene: its name.
    """
    columns = 1 + len(labels)
    across = 2 if columns <= MOST_BESIDE else 1
    cell = _cell_width(across * columns, WIDEST_CROP)
    high, wide = pictures.valid.shape
    width = int(cell * DPI / ZOOM)
    if width <= wide // 3:
        cell = width * ZOOM / DPI
    else:  # a small frame, whose crops are enlarged more
        width = max(1, wide // 3)
    height = max(1, min(round(width / ASPECT), high // 3))
    errors = [pictures.error(method, slice(None)) for method in labels]
    boxes = choose_boxes(errors, pictures.smooth, height, width)
    grid = _Grid(pictures, labels, dict(zip(BOXES, boxes)), cell, across)
    middle = len(pictures.lights) // 2
    text = (
        f"{scene}, {pictures.lights[middle]}, exact; its boxes, enlarged {cell * DPI / width:.2g} times, "
        f"by each method and light. {ABOUT_ERRORS}"
    )
    return _sheet(title, grid, text, pictures.exact[middle])


def whole_sheet(
    pictures: SoftPictures, labels: Mapping[str, str], title: str, window: Window
) -> Figure:
    """Draw a window of a frame by method and light; without exact shadows, without errors.

    Args:
        labels: see `crop_sheet`.
    """
    columns = len(labels) + (pictures.exact is not None)
    highest = HIGHEST_WHOLE * window.width / window.height
    grid = _Grid(pictures, labels, {"": window}, min(_cell_width(columns, WIDEST_WHOLE), highest))
    return _sheet(title, grid, "" if pictures.exact is None else ABOUT_ERRORS)


def _cell_width(columns: int, widest: float) -> float:
    """Width of a picture of so many columns, at most `widest` unless the figure gets too narrow."""
    most, least = ((width - 2 * EDGE - MARGIN) / columns - WIDE_GAP for width in (WIDTH, NARROWEST))
    return max(min(most, widest), least)


@dataclass(frozen=True)
class _Grid:
    """Pictures by method, light and window, and below each its error.

    Args:
        windows: by letter; as many as `across` stand side by side.
        cell: width of a picture.
    """

    pictures: SoftPictures
    labels: Mapping[str, str]
    windows: Mapping[str, Window]
    cell: float
    across: int = 1

    @property
    def tall(self) -> float:
        """Height of a picture."""
        window = next(iter(self.windows.values()))
        return self.cell * window.height / window.width

    @property
    def columns(self) -> dict[str | None, str]:
        """Names by method; None is the exact shadow."""
        exact = {} if self.pictures.exact is None else {None: "Exact"}
        return exact | dict(self.labels)

    @property
    def pitch(self) -> float:
        """From a method's column to the next."""
        return self.across * self.cell + (self.across - 1) * GAP + WIDE_GAP

    @property
    def rows(self) -> int:
        """Rows of pictures of a light, errors among them."""
        return len(self.windows) // self.across * (1 + (self.pictures.exact is not None))

    @property
    def block(self) -> float:
        """Height of a light's rows."""
        return self.rows * (self.tall + GAP) - GAP

    @property
    def heads(self) -> dict[str | None, str]:
        """Names in lines as wide as a column."""
        letters = max(8, int(LETTERS * (self.pitch - WIDE_GAP)))
        return {key: _lines(name, letters) for key, name in self.columns.items()}

    @property
    def head(self) -> float:
        """Height of the names."""
        return LINE * max(text.count("\n") + 1 for text in self.heads.values()) + 0.05

    @property
    def width(self) -> float:
        """Of all columns, with the lights' names."""
        return MARGIN + len(self.columns) * self.pitch - WIDE_GAP

    @property
    def height(self) -> float:
        """Of all rows, with the methods' names."""
        return self.head + len(self.pictures.lights) * (self.block + WIDE_GAP)

    def draw(self, figure: Figure, top: float) -> None:
        """Draw everything below `top`."""
        first = top + self.head
        for column, (method, name) in enumerate(self.heads.items()):
            left = EDGE + MARGIN + column * self.pitch
            for line, text in enumerate(reversed(name.split("\n"))):
                _write(figure, left, first - 0.08 - line * LINE, text, va="baseline")
            for light in range(len(self.pictures.lights)):
                self._draw_light(
                    figure, left, first + light * (self.block + WIDE_GAP), method, light
                )
        for light, name in enumerate(self.pictures.lights):
            middle = first + light * (self.block + WIDE_GAP) + self.block / 2
            text = _lines(name, max(10, int(LETTERS * self.block)))
            look = {"rotation": 90, "ha": "center", "va": "center", "multialignment": "center"}
            _write(figure, EDGE + MARGIN / 2, middle, text, **look)

    def _draw_light(
        self, figure: Figure, left: float, top: float, method: str | None, light: int
    ) -> None:
        pictures = self.pictures
        images = pictures.exact if method is None else pictures.answers[method]
        rows = [pictures.shown(images[light])]
        if pictures.exact is not None:
            # The exact shadow has no errors; without a shading its picture is its visibility.
            rows.append(coloured(pictures.error(method, light)) if method else images[light])
        for number, (letter, window) in enumerate(self.windows.items()):
            for row, image in enumerate(rows):
                x = left + number % self.across * (self.cell + GAP)
                y = top + (number // self.across * len(rows) + row) * (self.tall + GAP)
                panel = _axes(figure, x, y, self.cell, self.tall)
                _show(panel, window.of(image), self.cell, BOXES.get(letter, FRAME))
                if row == 0 and method is None and letter:
                    _badge(panel, letter)
                elif row == 1 and method and number == 0:
                    _corner(panel, _number(pictures.mse(method, light)))


def _sheet(title: str, grid: _Grid, text: str, scene: np.ndarray | None = None) -> Figure:
    """A figure of a grid, below the text and, beside it, a picture of the scene with the boxes."""
    from matplotlib.figure import Figure

    width = grid.width + 2 * EDGE
    title = _lines(title, int(TITLE_LETTERS * width))
    top = EDGE + TITLE_LINE * (title.count("\n") + 1)
    view, tall = 0.0, 0.0
    if scene is not None:
        high, wide = scene.shape
        view = min(OVERVIEW, grid.width - BESIDE, round(OVERVIEW * DPI / wide) * wide / DPI)
        tall = view * high / wide
    beside = grid.width - view - (scene is not None) * 2 * WIDE_GAP
    text = _lines(text, int(LETTERS * beside))
    explained = LINE * (text.count("\n") + 1) + SCALE if text else 0
    start = top + max(tall, explained) + WIDE_GAP
    figure = Figure(figsize=(width, start + grid.height + EDGE), dpi=DPI)
    _write(figure, EDGE, EDGE, title, fontsize=12, weight="bold")
    if scene is not None:
        panel = _axes(figure, EDGE, top, view, tall)
        _show(panel, grid.pictures.shown(scene), view, FRAME)
        for letter, window in grid.windows.items():
            _mark(panel, window, letter)
    if text:
        left = EDGE + grid.width - beside
        _write(figure, left, top, text)
        _draw_scale(figure, left, top + explained - SCALE + 0.1, min(beside, 3.0))
    grid.draw(figure, start)
    return figure


def _lines(text: str, letters: int) -> str:
    return TextWrapper(letters, break_on_hyphens=False).fill(text)


def _axes(figure: Figure, left: float, top: float, width: float, height: float) -> Axes:
    across, down = figure.get_size_inches()
    return figure.add_axes(
        (left / across, 1 - (top + height) / down, width / across, height / down)
    )


def _write(figure: Figure, left: float, top: float, text: str, **look: object) -> None:
    across, down = figure.get_size_inches()
    look = {"fontsize": 9, "va": "top", "ha": "left", "linespacing": 1.15} | look
    figure.text(left / across, 1 - top / down, text, **look)


def _show(axes: Axes, image: np.ndarray, width: float, colour: str) -> None:
    # Of a larger picture not every n-th pixel.
    smaller = image.shape[1] > width * DPI
    interpolation = "antialiased" if smaller else "none"
    axes.imshow(image, cmap="gray", vmin=0, vmax=1, interpolation=interpolation, aspect="auto")
    frame_picture(axes, colour, 0.8)  # much of most pictures is white


def _mark(axes: Axes, box: Window, letter: str) -> None:
    from matplotlib.patches import Rectangle

    left, right, lower, upper = box.extent
    look = {"fill": False, "edgecolor": BOXES[letter], "linewidth": 1.5}
    axes.add_patch(Rectangle((left, upper), right - left, lower - upper, **look))
    _badge(axes, letter, (left, upper), "data")


def _badge(
    axes: Axes, letter: str, place: tuple[float, float] = (0, 1), of: str = "axes fraction"
) -> None:
    """Write a box's letter into its upper left corner."""
    look = {"fontsize": 8, "weight": "bold", "color": "white", "va": "top", "ha": "left"}
    patch = {"facecolor": BOXES[letter], "edgecolor": "none", "pad": 1.5}
    offset = {"xytext": (2, -2), "textcoords": "offset points"}
    axes.annotate(letter, place, xycoords=of, bbox=patch, **offset, **look)


def _corner(axes: Axes, text: str) -> None:
    patch = {"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 1}
    axes.text(*(0.03, 0.05, text), transform=axes.transAxes, fontsize=8, bbox=patch, va="bottom")


def _number(mse: float) -> str:
    metric = metrics()["mse"]
    return f"{mse * metric.factor:.{metric.digits}f}"


def _draw_scale(figure: Figure, left: float, top: float, width: float) -> None:
    """The colours of errors, from false shadow to light leak."""
    axes = _axes(figure, left, top, width, 0.13)
    axes.imshow(coloured(np.linspace(-FULL, FULL, 101))[None], aspect="auto")
    frame_picture(axes, FRAME)
    texts = {0: f"≤ −{FULL:g}, false shadow", 0.5: "0", 1: f"light leak, ≥ {FULL:g}"}
    for place, text in texts.items():
        side = {0: "left", 0.5: "center", 1: "right"}[place]
        axes.text(*(place, -0.35, text), transform=axes.transAxes, fontsize=8, va="top", ha=side)

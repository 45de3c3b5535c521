"""Sheets of soft shadows: places, sizes and numbers of their pictures."""

import numpy as np
import pytest
from screen_frames import edge
from soft_pictures import LABELS, seen, write_soft_pictures

from neural_shadows.rendering.soft_shading import Shading
from neural_shadows.reports.data.frame_errors import Window
from neural_shadows.reports.data.soft_pictures import SoftPictures, read_pictures
from neural_shadows.reports.drawing.soft_sheet import ZOOM, crop_sheet, whole_sheet

LIGHTS = [f"light of {radius} m radius" for radius in (0.0312, 0.125, 0.25)]
SHAPE = 3, 128, 256
LONG = "PCSS, map of 2048², depth-aware filter, and more words than fit"


def made(methods: int, shaded: bool = True, exact: bool = True) -> tuple[SoftPictures, dict]:
    """Noise by so many methods, and their names."""
    rng = np.random.default_rng(methods)
    shading = Shading(np.full(SHAPE[1:], 0.7), np.full(SHAPE[1:], 0.2)) if shaded else None
    answers = {f"method_{k}": rng.random(SHAPE) for k in range(methods)}
    valid = np.ones(SHAPE[1:], bool)
    target = rng.random(SHAPE) if exact else None
    pictures = SoftPictures(LIGHTS, target, answers, valid, valid, shading)
    return pictures, {method: f"{LONG} {method[-1]}" for method in answers}


def boxes_of(figure):
    """Extents in pixels of all pictures, and of all texts outside them."""
    pictures = [axes.get_window_extent() for axes in figure.axes]
    return pictures, [text.get_window_extent() for text in figure.texts]


def apart(boxes):
    # Rasterised lines of text touch by a fraction of a pixel.
    return all(
        a.x1 <= b.x0 + 1 or b.x1 <= a.x0 + 1 or a.y1 <= b.y0 + 1 or b.y1 <= a.y0 + 1
        for k, a in enumerate(boxes)
        for b in boxes[:k]
    )


@pytest.mark.parametrize("methods", [1, 5, 6, 10])
def test_a_sheet_of_crops_has_no_empty_cell_and_nothing_overlaps(methods):
    pictures, labels = made(methods)
    figure = crop_sheet(pictures, labels, "Soft shadows of a long title " * 4, "room")
    overview, scale, *cells = figure.axes
    assert len(cells) == (1 + methods) * len(LIGHTS) * 2 * 2
    assert all(axes.images for axes in figure.axes)
    shown, texts = boxes_of(figure)
    assert apart([*shown, *texts])
    edges = figure.bbox
    assert all(edges.x0 <= b.x0 and b.x1 <= edges.x1 for b in [*shown, *texts])
    assert all(edges.y0 <= b.y0 and b.y1 <= edges.y1 for b in [*shown, *texts])
    # A pixel of a crop is four wide and four high.
    for axes, box in zip(cells, shown[2:]):
        rows, columns = axes.images[0].get_array().shape[:2]
        assert (box.width, box.height) == pytest.approx((ZOOM * columns, ZOOM * rows), rel=1e-6)
    assert len(overview.patches) == 2
    assert sum(text.get_text() in "ab" for text in overview.texts) == 2


def test_a_sheet_shows_a_frame_s_errors_and_its_crops_where_they_are(tmp_path):
    given = write_soft_pictures(tmp_path)
    paths = {path.stem: path for path in given["soft_answers"]}
    pictures = read_pictures(given["soft_parts"][0], paths, [0, 1])
    figure = crop_sheet(pictures, LABELS, "A wall", "room")
    numbers = [text.get_text() for axes in figure.axes[2:] for text in axes.texts]
    # Of 62 columns, under the point light, one is wrong, none, and two.
    for columns in (1, 0, 2):
        assert f"{1e4 * columns / 62:.1f}" in numbers
    boxes = figure.axes[0].patches
    left, right = (min(f(b) for b in boxes) for f in (lambda b: b.get_x(), lambda b: -b.get_x()))
    assert left <= 26 and -right + boxes[0].get_width() >= 22
    exact = edge(24.0)
    shown = np.where(pictures.valid, seen("hard", 0), exact)
    np.testing.assert_allclose(pictures.error("hard", 0), shown - exact, atol=1e-6)


@pytest.mark.parametrize(("shaded", "exact"), [(True, True), (False, True), (False, False)])
def test_a_sheet_of_a_window_has_errors_where_the_exact_shadow_is_known(shaded, exact):
    pictures, labels = made(3, shaded, exact)
    figure = whole_sheet(pictures, labels, "A frame", Window(10, 20, 64, 64))
    assert len(figure.axes) == (3 + exact) * len(LIGHTS) * (1 + exact) + exact
    shapes = {axes.images[0].get_array().shape[:2] for axes in figure.axes[exact:]}
    assert shapes == {(64, 64)}
    assert apart([box for boxes in boxes_of(figure) for box in boxes])

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

from neural_shadows.evaluation.first_frames import FirstFrame
from neural_shadows.reports.figures.pictures import choose_crop, picture_strip


def discs(first, second):
    """Dark discs of two radii on light ground."""
    rows, columns = np.mgrid[:100, :150]
    dark = (rows - 25) ** 2 + (columns - 30) ** 2 < first**2
    dark |= (rows - 70) ** 2 + (columns - 110) ** 2 < second**2
    return np.where(dark, 0.25, 0.9).astype(np.float32)


def test_crop_lies_where_a_border_is_wrong():
    reference, first, second = discs(8, 8), discs(6, 8), discs(8, 6)
    row, column, height, width = choose_crop({"network": second, "reference": reference})
    assert (height, width) == (20, 30)
    assert (row + height / 2, column + width / 2) == pytest.approx((70, 110), abs=1)
    # Each method counts.
    frames = {"a": first, "b": second, "c": first, "reference": reference}
    assert choose_crop(frames)[0] < 50
    # Equal frames give the middle.
    assert choose_crop({"network": second, "reference": second}) == (40, 60, 20, 30)


def test_strips_show_frames_crops_and_scores_and_long_names_do_not_overlap():
    labels = {f"map_{i}": f"Occupancy-clipped ray grid (single axis) {i}" for i in range(8)}
    labels = {"reference": "Reference", **labels}
    images = {
        name: np.uint8(255 * np.roll(discs(20, 12), i, axis=1)) for i, name in enumerate(labels)
    }
    frame = FirstFrame("Cast shadow", images, {"map_0": {"psnr": 27.39}})
    figure = picture_strip([frame] * 2, labels, "landscape")
    shown = [axes for axes in figure.axes if axes.images]
    assert len(shown) == 2 * 2 * 9
    row, column, height, width = choose_crop({m: i / np.float32(255) for m, i in images.items()})
    crops = [axes for axes in shown if axes.get_xlabel()]
    assert [axes.get_xlabel() for axes in crops] == ["PSNR 27.39 dB"] * 2
    part = images["map_0"][row : row + height, column : column + width] / np.float32(255)
    np.testing.assert_array_equal(crops[0].images[0].get_array(), part)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    boxes = [axes.title.get_window_extent(canvas.get_renderer()) for axes in shown]
    boxes = [box for box in boxes if box.width > 1]
    assert not any(a.overlaps(b) for i, a in enumerate(boxes) for b in boxes[:i])

import re
import subprocess
import sys
import xml.etree.ElementTree

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from PIL import Image

from neural_shadows.reports.figures.pictures import choose_crop, picture_strip
from neural_shadows.reports.figures.style import write_strip

LABELS = {
    "shadow_map_256": "256² shadow map",
    "network": "Our method",
    "reference": "Reference",
}


def discs(discs_drawn, shape=(100, 150)):
    """Dark discs, each (row, column, radius), on light ground."""
    rows, columns = np.mgrid[: shape[0], : shape[1]]
    dark = np.zeros(shape, bool)
    for row, column, radius in discs_drawn:
        dark |= (rows - row) ** 2 + (columns - column) ** 2 < radius**2
    return np.where(dark, 0.25, 0.9).astype(np.float32)


def blocks(image, size):
    return np.kron(image[::size, ::size], np.ones((size, size), np.float32))


def test_crop_lies_where_a_border_is_wrong():
    # Two discs; only the second is rendered otherwise. It fits the crop, which centres on it.
    reference = discs([(25, 30, 8), (70, 110, 8)])
    shrunk = discs([(25, 30, 8), (70, 110, 6)])
    row, column, height, width = choose_crop({"network": shrunk, "reference": reference})
    assert (height, width) == (20, 30)
    assert row + height / 2 == pytest.approx(70, abs=1)
    assert column + width / 2 == pytest.approx(110, abs=1)


def test_a_difference_away_from_borders_does_not_count():
    reference = discs([(25, 30, 8)])
    network = discs([(25, 30, 7)])
    network[60:95, 80:140] = 0.4  # much larger, but no shadow border of the reference is there
    row, column, height, width = choose_crop({"network": network, "reference": reference})
    assert row <= 25 < row + height
    assert column <= 30 < column + width


def test_each_method_counts():
    reference = discs([(25, 30, 8), (70, 110, 8)])
    first = discs([(25, 30, 6), (70, 110, 8)])
    second = discs([(25, 30, 8), (70, 110, 6)])
    frames = {"a": first, "b": second, "c": second, "reference": reference}
    assert choose_crop(frames)[0] > 50
    assert choose_crop(frames | {"c": first})[0] < 50


def test_crop_has_the_most_wrong_border_pixels():
    rng = np.random.default_rng(3)
    shape = (48, 64)
    reference = blocks(rng.choice([0.25, 0.9], shape).astype(np.float32), 4)
    network = blocks(rng.choice([0.25, 0.9], shape).astype(np.float32), 2)
    row, column, height, width = choose_crop({"network": network, "reference": reference})

    wrong = np.abs(network - reference) > 0.05
    near = np.pad(reference, 1, mode="edge")
    around = np.stack([near[i : i + 48, j : j + 64] for i in range(3) for j in range(3)])
    wrong &= np.ptp(around, axis=0) > 0.1
    counts = np.lib.stride_tricks.sliding_window_view(wrong, (height, width)).sum(axis=(2, 3))
    assert counts[row, column] == counts.max() > counts.min()


def test_equal_frames_give_the_middle():
    reference = discs([(25, 30, 8)])
    assert choose_crop({"network": reference, "reference": reference}) == (40, 60, 20, 30)


@pytest.fixture
def frames():
    views = []
    for reference in (discs([(40, 60, 20), (70, 110, 12)]), discs([(60, 40, 25), (30, 100, 9)])):
        views.append(
            {
                "reference": reference,
                "network": np.roll(reference, 1, axis=1),
                "shadow_map_256": blocks(reference, 5),
            }
        )
    return views


def test_strip_shows_frames_and_crops(frames):
    scores = [{"network": {"psnr": 27.39}, "shadow_map_256": {"psnr": 29.42}}] * 2
    figure = picture_strip(frames, LABELS, ["Cast shadow", "Surface"], title="wyrm", scores=scores)
    assert len(figure.axes) == 2 * 2 * 3
    row, column, height, width = choose_crop(frames[0])
    for i, method in enumerate(["shadow_map_256", "network", "reference"]):  # reference last
        whole, crop = figure.axes[2 * i], figure.axes[2 * i + 1]
        np.testing.assert_array_equal(whole.images[0].get_array(), frames[0][method])
        np.testing.assert_array_equal(
            crop.images[0].get_array(),
            frames[0][method][row : row + height, column : column + width],
        )
        assert crop.images[0].get_interpolation() == "nearest"
        assert whole.images[0].get_clim() == crop.images[0].get_clim() == (0, 1)
        (marked,) = whole.patches
        assert (marked.get_x() + 0.5, marked.get_y() + 0.5) == (column, row)
        assert (marked.get_width(), marked.get_height()) == (width, height)
    texts = [text.get_text() for text in figure.texts]
    assert {"wyrm", "Cast shadow", "Surface", *LABELS.values()} <= set(texts)
    assert texts.count("PSNR 27.39 dB") == 2
    assert not any("LPIPS" in text for text in texts)


def test_names_and_captions_do_not_overlap(frames):
    labels = {f"map_{i}": "Our method (single axis)" for i in range(7)} | {"reference": "Reference"}
    views = [{name: view["network"] for name in labels} for view in frames]
    figure = picture_strip(views, labels, ["Cast shadow", "Surface"], title="landscape")
    renderer = FigureCanvasAgg(figure).get_renderer()
    boxes = [text.get_window_extent(renderer) for text in figure.texts]
    assert not any(a.overlaps(b) for i, a in enumerate(boxes) for b in boxes[:i])


def test_both_files_are_written_and_repeat(frames, tmp_path):
    png, svg = tmp_path / "strip.png", tmp_path / "strip.svg"
    contents = []
    for _ in range(2):
        figure = picture_strip(frames, LABELS, ["Cast shadow", "Surface"], title="wyrm")
        write_strip(figure, png, svg)
        contents.append((png.read_bytes(), svg.read_bytes()))
    assert contents[0] == contents[1]
    assert sorted(path.name for path in tmp_path.iterdir()) == ["strip.png", "strip.svg"]

    with Image.open(png) as picture:
        assert picture.width == pytest.approx(2040, abs=1)
        crop_colour = np.array([0xE4, 0x57, 0x2E])
        assert (np.asarray(picture.convert("RGB")) == crop_colour).all(axis=2).sum() > 1000
    root = xml.etree.ElementTree.parse(svg).getroot()
    assert len(list(root.iter("{http://www.w3.org/2000/svg}image"))) == 12
    assert not re.search(r"<dc:date>", svg.read_text())


def test_importing_needs_no_matplotlib():
    code = "import sys, neural_shadows.strips; sys.exit('matplotlib' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0

import numpy as np
import pandas as pd
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from PIL import Image

from neural_shadows.evaluation.first_frames import FirstFrame, write_first_frames
from neural_shadows.files.whole_files import write_json
from neural_shadows.reports.figures.pictures import choose_crop, draw, picture_strip

LABELS = {"reference": "Reference", "map": "256² shadow map", "network": "Our method"}


def discs(*discs_drawn):
    """Dark discs, each (row, column, radius), on light ground."""
    rows, columns = np.mgrid[:100, :150]
    dark = np.zeros((100, 150), bool)
    for row, column, radius in discs_drawn:
        dark |= (rows - row) ** 2 + (columns - column) ** 2 < radius**2
    return np.where(dark, 0.25, 0.9).astype(np.float32)


def test_crop_lies_where_a_border_is_wrong():
    # Two discs; only the second is rendered otherwise. It fits the crop, which centres on it.
    reference = discs((25, 30, 8), (70, 110, 8))
    second = discs((25, 30, 8), (70, 110, 6))
    row, column, height, width = choose_crop({"network": second, "reference": reference})
    assert (height, width) == (20, 30)
    assert (row + height / 2, column + width / 2) == pytest.approx((70, 110), abs=1)
    # Each method counts.
    frames = {"a": discs((25, 30, 6), (70, 110, 8)), "b": second, "reference": reference}
    assert choose_crop(frames | {"c": second})[0] > 50
    assert choose_crop(frames | {"c": frames["a"]})[0] < 50
    # Equal frames give the middle.
    assert choose_crop({"network": second, "reference": second}) == (40, 60, 20, 30)


def test_crop_has_the_most_wrong_border_pixels():
    rng = np.random.default_rng(3)
    reference, network = (
        np.kron(rng.choice(np.float32([0.25, 0.9]), (48 // n, 64 // n)), np.ones((n, n)))
        for n in (4, 2)
    )
    row, column, height, width = choose_crop({"network": network, "reference": reference})
    near = np.pad(reference, 1, mode="edge")
    around = np.stack([near[i : i + 48, j : j + 64] for i in range(3) for j in range(3)])
    wrong = (np.abs(network - reference) > 0.05) & (np.ptp(around, axis=0) > 0.1)
    counts = np.lib.stride_tricks.sliding_window_view(wrong, (height, width)).sum(axis=(2, 3))
    assert counts[row, column] == counts.max() > counts.min()


def frame_of(labels):
    reference = discs((40, 60, 20), (70, 110, 12))
    others = {name: np.roll(reference, i, axis=1) for i, name in enumerate(labels)}
    images = {name: np.round(255 * image).astype(np.uint8) for name, image in others.items()}
    return FirstFrame("Cast shadow", images, {"network": {"psnr": 27.39}})


def test_strip_shows_frames_and_crops():
    frame = frame_of(LABELS)
    figure = picture_strip([frame] * 2, LABELS, "wyrm")
    images = {name: image.astype(np.float32) / 255 for name, image in frame.images.items()}
    row, column, height, width = choose_crop(images)
    assert len(figure.axes) == 2 * 2 * 3
    for i, method in enumerate(["map", "network", "reference"]):  # reference last
        whole, crop = figure.axes[2 * i], figure.axes[2 * i + 1]
        np.testing.assert_array_equal(whole.images[0].get_array(), images[method])
        part = images[method][row : row + height, column : column + width]
        np.testing.assert_array_equal(crop.images[0].get_array(), part)
        (marked,) = whole.patches
        assert (marked.get_x() + 0.5, marked.get_y() + 0.5) == (column, row)
    texts = [text.get_text() for text in figure.texts]
    assert {"wyrm", "Cast shadow", *LABELS.values()} <= set(texts)
    assert texts.count("PSNR 27.39 dB") == 2
    assert not any("LPIPS" in text for text in texts)


def test_long_names_break_and_do_not_overlap():
    labels = {f"map_{i}": "Occupancy-clipped ray grid (single axis)" for i in range(8)}
    labels |= {"reference": "Reference"}
    figure = picture_strip([frame_of(labels)] * 2, labels, "landscape")
    renderer = FigureCanvasAgg(figure).get_renderer()
    boxes = [text.get_window_extent(renderer) for text in figure.texts]
    assert not any(a.overlaps(b) for i, a in enumerate(boxes) for b in boxes[:i])
    assert all(0 <= box.x0 and box.x1 <= figure.bbox.x1 for box in boxes)


def test_the_figure_is_drawn_of_files(tmp_path):
    mesh_json, csv, png, svg = (
        tmp_path / f"a.{ending}" for ending in ("json", "csv", "png", "svg")
    )
    write_json(mesh_json, {"name": "wyrm"})
    for name, image in frame_of(LABELS).images.items():
        views = dict.fromkeys(("shadow", "surface"), image / 255)
        write_first_frames(tmp_path / f"{name}.npz", name, views)
    values = {"view_set": ["shadow", "surface"], "method": "map", "metric": "psnr", "value": 30.0}
    pd.DataFrame({"view": 0, **values}).to_csv(csv, index=False)
    pictures = [tmp_path / f"{name}.npz" for name in LABELS]
    rows = [{"method": "map", "label": "a map"}, {"method": "network", "label": "a network"}]
    told = {"rows": rows, "view_sets": ["surface"], "run": {"scale": "test"}}
    draw([csv], pictures, mesh_json, png, svg, title="Pictures", **told)
    with Image.open(png) as picture:
        assert picture.width == pytest.approx(2040, abs=1)
    assert svg.read_text(encoding="utf-8").count("<image") == 6

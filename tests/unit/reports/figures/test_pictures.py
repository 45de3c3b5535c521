import numpy as np
import pytest
import report_samples as samples
from frame_samples import write_frames
from matplotlib.backends.backend_agg import FigureCanvasAgg

from neural_shadows.reports.figures import pictures
from neural_shadows.reports.figures.pictures import choose_crop, picture_strip
from neural_shadows.reports.frames import Frame
from neural_shadows.reports.tables.quality import METRICS


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
    images = {name: np.roll(discs(20, 12), i, axis=1) for i, name in enumerate(labels)}
    frame = Frame(("shadow", 3), images, {"map_0": {"psnr": 27.39}})
    figure = picture_strip([frame] * 2, labels, "landscape")
    shown = [axes for axes in figure.axes if axes.images]
    assert len(shown) == 2 * 2 * 9
    row, column, height, width = choose_crop(images)
    crops = [axes for axes in shown if axes.get_xlabel()]
    assert [axes.get_xlabel() for axes in crops] == ["PSNR 27.39 dB"] * 2
    part = images["map_0"][row : row + height, column : column + width]
    np.testing.assert_array_equal(crops[0].images[0].get_array(), part)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    boxes = [axes.title.get_window_extent(canvas.get_renderer()) for axes in shown]
    boxes = [box for box in boxes if box.width > 1]
    assert not any(a.overlaps(b) for i, a in enumerate(boxes) for b in boxes[:i])


def test_a_network_that_has_not_learned_says_so_under_its_name(tmp_path, monkeypatch):
    drawn = []
    monkeypatch.setattr(pictures, "write_figure", lambda figure, *paths: drawn.append(figure))
    labels = {"dragon": "Network", "shadow_map_512": "512² shadow map"}
    images = {"dragon": discs(20, 0), "shadow_map_512": discs(20, 12), "reference": discs(20, 12)}
    seen = {m: {("shadow", view): image for view in range(6)} for m, image in images.items()}
    references, visibilities = write_frames(tmp_path, seen)
    worse, better = (0.2, 15.0, 0.8), (0.1, 30.0, 0.9)
    quality = {"dragon": worse, "no_shadow": worse, "shadow_map_512": better}
    means = {
        method: dict.fromkeys(METRICS, 0.1) | dict(zip(("lpips", "psnr", "ssim"), values))
        for method, values in quality.items()
    }
    mesh = {"name": "wyrm", "faces": 4, "watertight": True, "thesis_mesh": False}
    pictures.draw(
        metrics=[samples.write_metrics(tmp_path, means)],
        references=references,
        visibilities=visibilities,
        mesh_json=samples.write_record(tmp_path / "mesh.json", mesh),
        published_csv=samples.PUBLISHED,
        png=tmp_path / "f.png",
        svg=tmp_path / "f.svg",
        title="Pictures",
        rows=[samples.row(method, label) for method, label in labels.items()],
        view_sets=["shadow"],
        run=samples.RUN,
    )
    heads = [axes.get_title() for axes in drawn[0].axes if axes.get_title()]
    assert heads == ["Network\n(not learned)", "512² shadow map", "Reference"]

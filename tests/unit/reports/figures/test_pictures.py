import numpy as np
import pytest
import report_samples as samples
from frame_samples import write_frames
from matplotlib.backends.backend_agg import FigureCanvasAgg

from neural_shadows.reports.data.frame_errors import (
    choose_boxes,
    choose_crops,
    coloured,
    error_layer,
    with_errors,
)
from neural_shadows.reports.data.frames import Frame
from neural_shadows.reports.data.method_look import look_of
from neural_shadows.reports.data.quality import METRICS
from neural_shadows.reports.figures import pictures
from neural_shadows.reports.figures.pictures import picture_strip


def discs(first, second):
    """Dark discs of two radii on light ground."""
    rows, columns = np.mgrid[:100, :150]
    dark = (rows - 25) ** 2 + (columns - 30) ** 2 < first**2
    dark |= (rows - 70) ** 2 + (columns - 110) ** 2 < second**2
    return np.where(dark, 0.25, 0.9).astype(np.float32)


def test_crops_lie_where_methods_err_most_and_no_method_outvotes_the_others():
    reference, first, second = discs(8, 8), discs(6, 8), discs(8, 6)
    outer, inner = choose_crops({"network": second, "reference": reference})
    assert outer[2:] == (20, 30) and inner[2:] == (6, 9)
    centre = outer.row + outer.height / 2, outer.column + outer.width / 2
    assert centre == pytest.approx((70, 110), abs=1)
    assert outer.row <= inner.row and inner.row + inner.height <= outer.row + outer.height
    assert inner.of(np.abs(second - reference)).sum() > 0
    # One that is wrong nearly everywhere counts as much as one that is wrong here and there.
    dark = np.full_like(reference, 0.25)
    assert choose_crops({"a": dark, "b": first, "reference": reference})[0].row < 30
    # Equal frames give the middle.
    assert choose_crops({"a": second, "reference": second})[0] == (40, 60, 20, 30)


def test_errors_are_red_where_too_dark_and_blue_where_too_light():
    reference, image = np.full((2, 3), 0.5), np.array([[0.5, 0.4, 0.6], [0.52, 0.48, 0.5]])
    red, green, blue = np.moveaxis(with_errors(image, reference), 2, 0)
    assert red[0, 1] > blue[0, 1] + 0.3 and blue[0, 2] > red[0, 2] + 0.3
    three = np.full((3, 9), 0.5)
    three[1, 4:7] = 0.6, 0.4, 0.6
    layer = error_layer(three, np.full_like(three, 0.5), 3)
    assert layer[0, :, 3].astype(bool).tolist() == [False] * 3 + [True] * 5 + [False]
    assert (layer[:, 4:7, 2] > layer[:, 4:7, 0]).tolist() == [[False, True, False]] * 3
    same = np.isin(image, (0.5, 0.52, 0.48))
    for channel in (red, green, blue):
        np.testing.assert_array_equal(channel[same], image[same])


def test_a_soft_shadow_s_errors_are_as_strong_as_they_are_large():
    none, leak, dark, weak = coloured(np.array([0.0, 0.5, -0.5, 0.25]))
    assert np.allclose(none, 1) and leak.argmax() == 2 and dark.argmax() == 0  # blue leaks
    assert np.allclose(weak, (1 + leak) / 2)
    assert np.allclose(coloured(np.array([1.0])), leak)  # half of the light has the whole colour


def test_boxes_lie_apart_where_methods_err_most_and_no_method_outvotes_the_others():
    first, second = np.zeros((2, 1, 60, 90))
    first[0, 10:16, 20:29] = 0.01
    second[0, 40:46, 60:69] = 1
    counted = np.ones((60, 90), bool)
    boxes = choose_boxes([first, second], counted, 6, 9)
    assert {*boxes} == {(10, 20, 6, 9), (40, 60, 6, 9)}
    counted[:30] = False
    assert choose_boxes([first, second], counted, 6, 9)[0] == (40, 60, 6, 9)
    # All errors in one place: the second box does not show it again, where there is room.
    second[0, 46:52, 60:69], counted = 0.5, np.ones((60, 90), bool)
    for rows, windows in ((60, 3), (18, 1)):
        (a, b) = choose_boxes(
            [second[:, -rows:, -3 * rows // 2 :]], counted[-rows:, -3 * rows // 2 :], 6, 9
        )
        assert abs(a.row - b.row) >= 6 * windows or abs(a.column - b.column) >= 9 * windows


def test_strips_show_frames_crops_and_scores_and_long_names_do_not_overlap():
    label = "Occupancy-clipped ray grid (single axis)"
    heads = {f"map_{i}": (f"{label} {i}", look_of(samples.row("shadow_map_64"))) for i in range(8)}
    images = {
        name: np.roll(discs(20, 12), i, axis=1) for i, name in enumerate(["reference", *heads])
    }
    frame = Frame(("shadow", 3), "View 3", images, {"map_0": {"psnr": 27.39}})
    figure = picture_strip([frame] * 2, heads, "landscape")
    shown = [axes for axes in figure.axes if axes.images]
    assert len(shown) == 2 * 3 * 9
    texts = [text.get_text() for axes in shown for text in axes.texts]
    assert texts.count("PSNR 27.4 dB") == 2
    coloured = with_errors(images["map_0"], images["reference"])
    for crop, axes in zip(choose_crops(images), shown[1:3]):
        np.testing.assert_array_equal(axes.images[0].get_array(), crop.of(coloured))
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    titles = figure.findobj(lambda artist: getattr(artist, "get_weight", str)() == "bold")
    boxes = [title.get_window_extent(canvas.get_renderer()) for title in titles if title.get_text()]
    assert len(boxes) == 19
    assert not any(a.overlaps(b) for i, a in enumerate(boxes) for b in boxes[:i])


def test_an_unlearned_network_is_marked_under_its_name(tmp_path):
    labels = {"dragon": "Network", "shadow_map_512": "512² shadow map"}
    images = {"dragon": discs(20, 0), "shadow_map_512": discs(20, 12), "reference": discs(20, 12)}
    frames = {m: {("shadow", view): image for view in range(6)} for m, image in images.items()}
    references, visibilities = write_frames(tmp_path, frames)
    worse, better = (0.2, 15.0, 0.8), (0.1, 30.0, 0.9)
    quality = {"dragon": worse, "no_shadow": worse, "shadow_map_512": better}
    means = {
        method: dict.fromkeys(METRICS, 0.1) | dict(zip(("lpips", "psnr", "ssim"), values))
        for method, values in quality.items()
    }
    mesh = {"name": "wyrm", "faces": 4, "watertight": True, "thesis_mesh": False}
    figure = pictures.draw(
        metrics=[samples.write_metrics(tmp_path, means)],
        references=references,
        visibilities=visibilities,
        mesh_json=samples.write_record(tmp_path / "mesh.json", mesh),
        published_csv=samples.PUBLISHED,
        title="Pictures",
        rows=[samples.row(method, label) for method, label in labels.items()],
        view_sets=["shadow"],
        run=samples.RUN,
    )
    heads = [axes.get_title(loc="left") for axes in figure.axes if axes.get_title(loc="left")]
    assert heads == ["Network\n(not learned)", "512² shadow map", "Reference"]

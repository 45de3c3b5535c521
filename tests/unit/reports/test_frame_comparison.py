import base64
import io

import numpy as np
import pytest
from PIL import Image
from report_page import LABELS, METHODS, write_frames
from report_samples import metrics_of, row, write_metrics

from neural_shadows.reports.frame_comparison import frame_comparisons, map_picture


@pytest.fixture
def compared(tmp_path):
    pictures = write_frames(tmp_path)
    scores = {method: {"psnr": 22.0, "lpips": 0.1} for method in METHODS}
    metrics = write_metrics(tmp_path, "dragon", metrics_of(scores, views=2))

    def compare(pictures=pictures, labels=LABELS):
        rows = [row(method, label) for method, label in zip(METHODS, labels)]
        return frame_comparisons(pictures, metrics, rows, {"dragon": "the dragon"})

    return compare, pictures


def decoded(uri):
    content = base64.b64decode(uri.removeprefix("data:image/webp;base64,"))
    return np.asarray(Image.open(io.BytesIO(content)))


def test_frames_are_stored_without_loss(compared):
    compare, pictures = compared
    (data,) = compare()
    (path,) = (path for path in pictures if path.name.startswith("dragon"))
    picture = data["views"][1]["pictures"]["dragon"]
    np.testing.assert_array_equal(
        decoded(picture["frame"])[..., 0], np.load(path)["surface.dragon"]
    )
    assert picture["scores"] == "LPIPS 0.1100, PSNR 24.20 dB"
    assert data["methods"][0] == {"key": "reference", "name": "Reference"}
    assert (data["left"], data["right"]) == ("dragon", "reference")


def test_methods_of_one_label_bear_their_keys(compared):
    compare, _ = compared
    (data,) = compare(labels=("A map", "A map", "Network"))
    names = [method["name"] for method in data["methods"]]
    assert names[1:] == ["A map (shadow_map_128)", "A map (shadow_map_512)", "Network"]


def test_without_a_reference_nothing_is_compared(compared):
    compare, pictures = compared
    assert compare(pictures[1:]) == []


def test_map_is_black_where_nothing_differs(compared):
    picture = np.asarray(map_picture(np.array([[0.0, 0.5, 1.0]])))
    assert picture[0, 0].tolist() == [0, 0, 4]
    assert picture[0, 2].tolist() == [252, 253, 191]  # magma's ends
    (data,) = compared[0]()
    assert decoded(data["views"][0]["pictures"]["reference"]["map"]).max() == 4

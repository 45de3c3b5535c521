import base64
import io

import numpy as np
from PIL import Image
from report_page import METHODS, write_frames
from report_samples import metrics_of, row, write_metrics

from neural_shadows.reports.frame_comparison import frame_comparisons, map_picture


def decoded(uri):
    content = base64.b64decode(uri.removeprefix("data:image/webp;base64,"))
    return np.asarray(Image.open(io.BytesIO(content)))


def test_frames_are_stored_without_loss_beside_their_scores_and_maps(tmp_path):
    pictures = write_frames(tmp_path)
    scores = {method: {"psnr": 22.0, "lpips": 0.1} for method in METHODS}
    metrics = write_metrics(tmp_path, "dragon", metrics_of(scores, views=2))
    # Two methods of one label bear their keys.
    rows = [row(m, label) for m, label in zip(METHODS, ("A map", "A map", "Network"))]
    (data,) = frame_comparisons(pictures, metrics, rows, {"dragon": "the dragon"})
    names = [method["name"] for method in data["methods"]]
    assert names == ["Reference", "A map (shadow_map_128)", "A map (shadow_map_512)", "Network"]
    assert (data["left"], data["right"]) == ("dragon", "reference")
    shown = data["views"][1]["pictures"]
    frame = decoded(shown["dragon"]["frame"])[..., 0]
    np.testing.assert_array_equal(frame, np.load(pictures[-1])["surface.dragon"])
    assert shown["dragon"]["scores"] == "LPIPS 0.1100, PSNR 24.20 dB"
    assert decoded(shown["reference"]["map"]).max() == 4  # magma's black

    # Without a reference nothing is compared.
    assert frame_comparisons(pictures[1:], metrics, rows, {}) == []


def test_map_is_black_where_nothing_differs():
    picture = np.asarray(map_picture(np.array([[0.0, 0.5, 1.0]])))
    assert picture[0, 0].tolist() == [0, 0, 4]
    assert picture[0, 2].tolist() == [252, 253, 191]  # magma's ends

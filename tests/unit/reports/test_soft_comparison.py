import base64
import io

import numpy as np
import pytest
from PIL import Image
from screen_frames import edge
from soft_pictures import LABELS, seen, write_soft_pictures

from neural_shadows.reports.page.frame_comparison import soft_comparisons


@pytest.fixture
def given(tmp_path):
    return [*write_soft_pictures(tmp_path).values()]


def opened(address):
    content = base64.b64decode(address.removeprefix("data:image/webp;base64,"))
    return Image.open(io.BytesIO(content)).convert("RGBA")


def test_each_scene_and_light_is_a_view_and_the_network_stands_beside_the_exact_shadow(given):
    (data,) = soft_comparisons(*given)
    assert (data["name"], data["title"]) == ("soft-rivals", "A wall")
    assert [view["caption"] for view in data["views"]] == [
        *("room, point light", "room, light of 0.25 m radius"),
        *("tree, point light", "tree, light of 0.25 m radius"),
    ]
    names = [method["name"] for method in data["methods"]]
    assert names == ["★ Reference", "■ Shadow map", "● 4 rays", "✦ Network"]
    assert (data["left"], data["right"]) == ("my_network", "reference")


def test_a_picture_is_what_was_answered_and_the_exact_shadow_where_nothing_counts(given):
    (data,) = soft_comparisons(*given)
    for k, view in enumerate(data["views"][:2]):
        for method in LABELS:
            frame = opened(view["reference"])
            frame.alpha_composite(opened(view["pictures"][method]["change"]))
            shown = seen(method, k)
            shown[:, :2] = edge(24.0, soft=4.0 * k)[:, :2]
            np.testing.assert_allclose(np.asarray(frame)[..., 0], 255 * shown, atol=1)


def test_scores_are_mean_squared_errors_of_what_counts_and_errors_lie_where_they_are(given):
    (data,) = soft_comparisons(*given)
    hard, soft = (view["pictures"] for view in data["views"][:2])
    # One column of 62 is dark where it should be lit.
    assert hard["hard"]["scores"] == f"MSE {1e4 / 62:.1f} × 10⁻⁴"
    layer = np.asarray(opened(hard["hard"]["errors"]))
    assert np.argwhere(layer[..., 3].any(axis=0)).ravel().tolist() == [24]
    assert hard["rt_4"]["scores"] == "MSE 0.0 × 10⁻⁴"
    layer = np.asarray(opened(soft["rt_4"]["errors"]))
    assert layer[..., 3].max() == 0


def test_of_a_half_finished_run_what_is_there_is_shown(given):
    parts, answers, pictures = given
    (data,) = soft_comparisons(parts[1:], answers[:2], pictures)
    assert [method["key"] for method in data["methods"]] == ["reference", "hard", "rt_4"]
    assert len(data["views"]) == 2 and data["left"] == "rt_4"  # which errs least
    assert soft_comparisons([], answers, pictures) == []
    assert soft_comparisons(parts, [], pictures) == []  # nothing to compare with

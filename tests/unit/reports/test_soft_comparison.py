import base64
import io

import numpy as np
import pytest
from PIL import Image
from screen_frames import edge
from soft_pictures import LABELS, seen, write_soft_pictures

from neural_shadows.reports.data.frame_errors import FULL
from neural_shadows.reports.page.soft_comparison import SHADES, soft_comparisons

LEAST_SHOWN = 255 * FULL / SHADES / 2  # levels, of an error


@pytest.fixture
def given(tmp_path):
    return [*write_soft_pictures(tmp_path).values()]


def opened(address):
    content = base64.b64decode(address.removeprefix("data:image/avif;base64,"))
    return np.asarray(Image.open(io.BytesIO(content)).convert("L"), int)


def test_a_table_shows_its_scenes_and_lights_by_the_method_that_errs_most_and_by_the_network(given):
    (data,) = soft_comparisons(*given)
    assert (data["name"], data["title"], data["soft"]) == ("soft-rivals", "A wall", True)
    assert [view["caption"] for view in data["views"]] == ["room", "tree"]
    assert data["lights"] == [
        {"name": "point light", "size": "point"},
        {"name": "light of 0.25 m radius", "size": "0.25 m"},
    ]
    names = [method["name"] for method in data["methods"]]
    assert names == ["★ Reference", "■ Shadow map", "● 4 rays", "✦ Network"]
    assert (data["left"], data["right"]) == ("hard", "my_network")


def test_a_picture_is_what_was_answered_and_the_exact_shadow_where_nothing_counts(given):
    (data,) = soft_comparisons(*given)
    for k, pictures in enumerate(data["views"][0]["lights"]):
        exact = opened(pictures["reference"]["visibility"])
        for method in LABELS:
            levels = opened(pictures[method]["visibility"])
            shown = seen(method, k)
            shown[:, :2] = edge(24.0, soft=4.0 * k)[:, :2]
            np.testing.assert_allclose(levels, 255 * shown, atol=LEAST_SHOWN)
            # Pixels that are equal are shown without an error.
            alike = shown == edge(24.0, soft=4.0 * k)
            assert np.abs(levels - exact)[alike].max() < LEAST_SHOWN


def test_a_wall_is_lit_by_its_cosine_and_by_the_upper_half_of_the_sky(given):
    view = soft_comparisons(*given)[0]["views"][0]
    np.testing.assert_allclose(opened(view["direct"]), 255 * 0.75 * 0.7, atol=2)
    np.testing.assert_allclose(opened(view["sky"]), 255 * 0.25 * 0.75, atol=2)


def test_scores_are_mean_squared_errors_of_what_counts(given):
    (data,) = soft_comparisons(*given)
    hard, soft = data["views"][0]["lights"]
    # One column of 62 is lit where it should be dark.
    assert hard["hard"]["scores"] == f"MSE {1e4 / 62:.1f} × 10⁻⁴"
    assert hard["rt_4"]["scores"] == soft["rt_4"]["scores"] == "MSE 0.0 × 10⁻⁴"


def test_of_a_half_finished_run_what_is_there_is_shown(given):
    parts, answers, pictures = given
    (data,) = soft_comparisons(parts[1:], answers[:2], pictures)
    assert [method["key"] for method in data["methods"]] == ["reference", "hard", "rt_4"]
    assert len(data["views"]) == 1 and (data["left"], data["right"]) == ("hard", "rt_4")
    (data,) = soft_comparisons(parts, answers[:1], pictures)
    assert (data["left"], data["right"]) == ("reference", "hard")
    assert soft_comparisons([], answers, pictures) == []
    assert soft_comparisons(parts, [], pictures) == []  # nothing to compare with

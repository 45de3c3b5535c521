import numpy as np
import pytest
from shapes import bumpy_sphere, looking, scene_of, unit

from neural_shadows.evaluation.shadow_methods import traced_method
from neural_shadows.rendering.exact_shadow import exact_visibility
from neural_shadows.rendering.gbuffer import render_gbuffer


@pytest.mark.parametrize("resolution", [64, 200])
def test_a_whole_map_answers_as_the_texels_in_use_do(resolution):
    scene, key = scene_of(bumpy_sphere(4)), f"shadow_map_{resolution}"
    frame = render_gbuffer(scene, looking((0, 1, 3), unit(1, 1, 0.3)), 150, 100)
    lazy = traced_method(key, scene)(frame)
    np.testing.assert_array_equal(traced_method(key, scene, whole_map=True)(frame), lazy)
    exact = traced_method("ray_traced", scene)(frame)
    np.testing.assert_array_equal(exact, exact_visibility(scene.tracer, frame))
    assert lazy.dtype == exact.dtype == np.float32 and lazy.shape == frame.pixel.shape
    assert 0 < np.mean(lazy != exact) < 0.1 and 0 < exact.mean() < 1

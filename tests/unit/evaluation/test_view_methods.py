import numpy as np
import pytest
from shapes import bumpy_sphere, looking, scene_of, unit

from neural_shadows.evaluation.registry import classic_method
from neural_shadows.rendering.exact_shadow import exact_visibility
from neural_shadows.rendering.gbuffer import render_gbuffer


@pytest.fixture(scope="module")
def bumpy():
    scene = scene_of(bumpy_sphere(5))
    return scene, render_gbuffer(scene, looking((1, 2, 2), unit(1, 1, 0.5)), 300, 200)


@pytest.mark.parametrize("bias", [0.0, 0.1, -0.1])
def test_null_predictors_ignore_the_object_and_the_bias(bumpy, bias):
    scene, frame = bumpy
    faces_light = np.zeros(len(frame.pixel))
    faces_light[frame.lit_side] = 1
    assert 0 < faces_light.mean() < 1
    found = classic_method("no_shadow", scene)(frame)(bias)
    np.testing.assert_array_equal(found, faces_light.astype(np.float32), strict=True)
    assert not classic_method("all_dark", scene)(frame)(bias).any()
    exact = classic_method("ray_traced", scene)(frame)(bias)
    np.testing.assert_array_equal(exact, exact_visibility(scene.tracer, frame))


@pytest.mark.parametrize("kind", ["", "_16bit", "_pcf", "_pcf_16bit"])
def test_maps_darken_with_less_bias_and_lighten_with_more(bumpy, kind):
    scene, frame = bumpy
    ask = classic_method(f"shadow_map{kind}_256", scene)(frame)
    none = ask(0.0)
    assert np.abs(none - exact_visibility(scene.tracer, frame)).mean() < 0.02
    for more, less in [(ask(0.2), none), (none, ask(-0.2))]:
        assert (more >= less).all() and more.mean() > less.mean() + 0.001
    # PCF has visibilities between.
    assert set(np.unique(none)) == {0, 1} or "pcf" in kind and len(np.unique(none)) > 100


def test_kinds_of_maps_are_told_apart(bumpy):
    scene, frame = bumpy
    exact = exact_visibility(scene.tracer, frame)
    kinds = ["", "_16bit", "_pcf"]
    answers = {k: classic_method(f"shadow_map{k}_1024", scene)(frame)(-0.003) for k in kinds}
    squares = {k: np.mean((answer - exact) ** 2) for k, answer in answers.items()}
    assert 0 < np.mean(answers[""] != answers["_16bit"]) < 0.01
    assert squares["_pcf"] < squares[""]


@pytest.mark.parametrize("kind", ["", "_pcf", "_16bit", "_pcf_16bit"])
def test_a_whole_map_answers_as_the_texels_in_use_do(bumpy, kind):
    scene, frame = bumpy
    lazy, whole = (
        classic_method(f"shadow_map{kind}_256", scene, whole_map=whole)(frame)(0.0)
        for whole in (False, True)
    )
    assert 0.01 < lazy.mean() < 0.99
    np.testing.assert_array_equal(whole, lazy)

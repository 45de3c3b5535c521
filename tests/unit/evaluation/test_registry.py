from types import SimpleNamespace

import numpy as np
import pytest
from plate_frames import plate_frame

from neural_shadows.errors import InputError
from neural_shadows.evaluation import registry as names
from neural_shadows.evaluation.method import Method, visibility
from neural_shadows.settings.kinds import kinds


@pytest.mark.parametrize(
    ("method", "module"),
    [
        *((f"shadow_map_{kind}", "shadow_map") for kind in ("2", "16bit_2048", "pcf_16bit_32768")),
        *(("no_shadow", "null"), ("all_dark", "null")),
    ],
)
def test_methods_that_need_no_network(method, module):
    assert names.is_classic(method) and names.method_of(method).label
    (path,) = names.method_modules([method, names.biased_key(method)])
    assert path.stem == module


@pytest.mark.parametrize(
    "method",
    ["dragon", "ray_traced", "shadow_map", "shadow_map_16bit", "shadow_map_1", "shadow_map_32769"]
    + ["shadow_map_pcf_", "shadow_map_8bit_512", "shadow_map_-4", "shadow_map_512_biased"],
)
def test_others(method):
    assert not names.is_classic(method)
    assert names.is_network(method) == (names.method_modules([method]) == set())


@pytest.mark.parametrize("method", ["dragon", "shadow_map_pcf_512"])
def test_a_bias_comes_off_a_key_again(method):
    biased = names.biased_key(method)
    assert biased != method == names.unbiased(biased) == names.unbiased(method)


def test_a_method_of_buffers_answers_frames_without_a_scene(monkeypatch):
    """So that it can stand in tables of a user's own frames."""
    method = Method(of_buffers=lambda *buffers: None)
    monkeypatch.setitem(names.METHODS, "mine", method)
    assert method.answers_frames and not method.answers_views
    assert not method.needs_scene and names.METHODS["pcss"].needs_scene


def test_a_key_is_of_one_family(monkeypatch):
    """A user's file cannot take the place of another's method unseen."""
    mine = SimpleNamespace(METHODS={"rt_4": Method()}, __file__="methods/mine.py")
    monkeypatch.setattr(names, "kinds", lambda folder: kinds(folder) | {"mine": mine})
    with pytest.raises(ValueError, match=r"ray_traced.py and mine.py both have 'rt_4'. Rename one"):
        names._families()


def test_candidates_are_a_list():
    with pytest.raises(ValueError, match="4 rays, box: the candidates of width are 3. List one"):
        Method(label="4 rays, box", constants={"width": 3})


def test_an_answer_is_of_the_points():
    """Not of the image, as a filter has it."""
    frame, image = plate_frame(), Method(lambda frame, radius: np.ones((4, 5)), label="Mine")
    with pytest.raises(InputError, match=r"Mine: it answers \(4, 5\) numbers. Return one for each"):
        visibility(image, frame, 0.1, {})

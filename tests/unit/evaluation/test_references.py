from dataclasses import fields

import numpy as np
import pytest
from evaluated import FRAMES, make_evaluated
from shapes import bumpy_sphere, scene_of

from neural_shadows.errors import InputError
from neural_shadows.evaluation.references import References, write_references
from neural_shadows.rendering.exact_shadow import exact_visibility
from neural_shadows.rendering.gbuffer import render_gbuffer
from neural_shadows.rendering.viewpoints import draw_viewpoints

W, H = FRAMES["width"], FRAMES["height"]


def assert_same(found, expected):
    for field in fields(expected):
        a, b = getattr(found, field.name), getattr(expected, field.name)
        if field.name == "view":
            assert_same(a, b)
        else:
            np.testing.assert_array_equal(a, b, strict=isinstance(b, np.ndarray))


@pytest.mark.parametrize("ground", [True, False])
def test_frames_come_back_to_the_bit(tmp_path, ground):
    scene = scene_of(bumpy_sphere(4), ground=ground)
    views = draw_viewpoints(scene, ["surface", "centre"], range(2), W / H, FRAMES["seed"])
    frames = [render_gbuffer(scene, view, W, H) for view in views]
    rng = np.random.default_rng(0)
    soft = [frame.visibility(rng.random(len(frame.lit_side))) for frame in frames]
    write_references(tmp_path / "000.safetensors", zip(frames, soft), scene.ground)
    found = References(tmp_path / "000.safetensors")
    assert len(found) == len(list(found)) == 4
    for (frame, visibility), expected, given in zip(found, frames, soft, strict=True):
        assert_same(frame, expected)
        np.testing.assert_array_equal(visibility, given, strict=True)


@pytest.mark.parametrize("reference", ["exact", "shadow_map"])
def test_a_batch_holds_the_views_of_each_set(tmp_path, reference):
    files = make_evaluated(tmp_path, first=1, reference=reference, threads=2)
    scene = scene_of(bumpy_sphere(4))
    found = list(References(files.references))
    keys = [(frame.view.view_set, frame.view.index) for frame, _ in found]
    assert keys == [("shadow", 1), ("shadow", 2), ("surface", 1), ("surface", 2)]
    wrong = [np.mean(answer != exact_visibility(scene.tracer, frame)) for frame, answer in found]
    assert max(wrong) == 0 if reference == "exact" else max(wrong) < 0.01
    # The same from another job, on one thread.
    again = make_evaluated(tmp_path / "again", first=1, reference=reference)
    assert again.references.read_bytes() == files.references.read_bytes()


def test_a_damaged_file_is_named(tmp_path):
    path = tmp_path / "000.safetensors"
    path.write_bytes(b"no safetensors")
    with pytest.raises(InputError, match=r"000\.safetensors: cannot be read"):
        References(path)

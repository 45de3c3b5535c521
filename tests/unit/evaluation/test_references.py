from dataclasses import asdict

import numpy as np
import pytest
from evaluated import FRAMES, make_evaluated
from shapes import bumpy_sphere, scene_of

from neural_shadows.errors import InputError
from neural_shadows.evaluation.answers import read_view
from neural_shadows.evaluation.metric_files import read_view_metrics
from neural_shadows.evaluation.references import References, write_references
from neural_shadows.rendering.exact_shadow import exact_visibility
from neural_shadows.rendering.gbuffer import render_gbuffer
from neural_shadows.rendering.viewpoints import draw_viewpoints

W, H = FRAMES["width"], FRAMES["height"]


@pytest.mark.parametrize("ground", [True, False])
def test_frames_come_back_to_the_bit(tmp_path, ground):
    scene = scene_of(bumpy_sphere(4), ground=ground)
    views = draw_viewpoints(scene, ["surface", "centre"], range(2), W / H, FRAMES["seed"])
    frames = [render_gbuffer(scene, view, W, H) for view in views]
    rng = np.random.default_rng(0)
    soft = [frame.visibility(rng.random(len(frame.lit_side))) for frame in frames]
    write_references(tmp_path / "000.safetensors", zip(frames, soft), scene.ground)
    found = References(tmp_path / "000.safetensors")
    for (frame, visibility), expected, given in zip(found, frames, soft, strict=True):
        np.testing.assert_equal(asdict(frame), asdict(expected))
        np.testing.assert_array_equal(visibility, given, strict=True)


@pytest.mark.parametrize("reference", ["exact", "shadow_map"])
def test_a_batch_holds_the_views_of_each_set(tmp_path, reference):
    files = make_evaluated(tmp_path, first=1, reference=reference)
    scene = scene_of(bumpy_sphere(4))
    found = list(References(files.references))
    keys = [(frame.view.view_set, frame.view.index) for frame, _ in found]
    assert keys == [("shadow", 1), ("shadow", 2), ("surface", 1), ("surface", 2)]
    wrong = [np.mean(answer != exact_visibility(scene.tracer, frame)) for frame, answer in found]
    assert max(wrong) == 0 if reference == "exact" else max(wrong) < 0.01


@pytest.mark.parametrize(
    "read",
    [
        References,
        lambda path: read_view_metrics([path]),
        lambda path: read_view(path, 0, None),
    ],
)
def test_a_damaged_file_is_named(tmp_path, read):
    path = tmp_path / "map.000"
    path.write_bytes(b"view,view_set\n1,shadow\n")
    with pytest.raises(InputError, match=r"map\.000: damaged"):
        read(path)

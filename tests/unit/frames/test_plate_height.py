"""A plate's object is as high as makes its penumbrae as wide as asked."""

import numpy as np
import pytest
import trimesh
from shapes import prepared

from neural_shadows.errors import InputError
from neural_shadows.frames.draw_settings import FrameKind, draw_setting
from neural_shadows.frames.penumbra_widths import model_widths
from neural_shadows.frames.plate_height import FOV, RADIUS, SIDE, height_of
from neural_shadows.frames.soft_scene import SoftScene
from neural_shadows.rendering.surface import see_surface

PICTURE = {"kind": "perspective", "fov": 80, "resolution": SIDE}
KIND = FrameKind(SIDE, SIDE, FOV, None, PICTURE, RADIUS)
PIXELS = 64  # of a side: a part of the frame's


@pytest.fixture(scope="module")
def ball(tmp_path_factory):
    """The mesh and its file."""
    mesh, _ = prepared(trimesh.creation.icosphere(3))
    path = tmp_path_factory.mktemp("ball") / "mesh.ply"
    trimesh.creation.icosphere(3).export(path)
    return mesh, path


@pytest.mark.parametrize("penumbra", [40, 180])
def test_frames_have_the_width_that_was_asked_for(ball, penumbra):
    """Other cameras than those that the height was found with, as frames are drawn."""
    _, path = ball
    told = {"generate": "plate", "seed": 7, "inserted": {"ball": "y"}, "penumbra": penumbra}
    scene = SoftScene(told, [path])
    found = []
    for number in range(32):
        setting = draw_setting(scene, KIND, np.random.default_rng((1, number)))
        surface = see_surface(scene.at_rest, setting.camera, PIXELS, PIXELS)
        focal = setting.camera.focal(SIDE)
        found.append(model_widths(scene.at_rest, surface, setting.centre, RADIUS, focal))
    widths = np.concatenate(found)
    assert np.percentile(widths[widths > 0], 95) == pytest.approx(penumbra, rel=0.05)
    # What a part's JSON tells opens the same scene, without another search.
    again = SoftScene(scene.settings, [path])
    assert again.settings == scene.settings
    assert np.array_equal(again.at_rest.joined.vertices, scene.at_rest.joined.vertices)


def test_a_width_that_no_height_gives_is_told(ball):
    mesh, _ = ball
    with pytest.raises(InputError, match=r"penumbra = 900: ball on a plate has \d+ to \d+ pixels"):
        height_of({"ball": mesh}, 900, np.random.default_rng(0))

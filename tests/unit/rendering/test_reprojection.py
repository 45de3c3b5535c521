"""Points of one frame are found again in the frame before."""

import numpy as np
import pytest
import trimesh
from shapes import Y_UP, scene_of, sheet

from neural_shadows.rendering.reprojection import Reprojection, looked_up, projected
from neural_shadows.rendering.surface import see_surface
from neural_shadows.scenes.cameras import Camera


@pytest.fixture(scope="module")
def scene():
    cube = trimesh.creation.box([0.5] * 3)
    cube.apply_translation([0, 0.25, 0])
    return scene_of(trimesh.util.concatenate([sheet(0.0, 4.0), cube]), ground=False)


def camera(shift=0.0):
    return Camera(np.array([1.5 + shift, 1.2, 1.8]), np.array([shift, 0.2, 0]), Y_UP, 40.0)


def test_a_frames_own_points_project_to_their_pixels(scene):
    surface = see_surface(scene, camera(), 60, 40)
    column, row, depth = projected(camera(), 60, 40, surface.p)
    assert np.allclose(np.round(row) * 60 + np.round(column), surface.pixel)
    assert np.abs(column - np.round(column)).max() < 1e-3 and depth.min() > 0.5


def test_points_are_found_where_they_were_and_hidden_ones_are_not(scene):
    before, now = (see_surface(scene, camera(shift), 120, 80) for shift in (0.0, 0.1))
    accepted, places = Reprojection(now, before).seen
    assert 0.75 < accepted.mean() < 0.98
    # The world's x there is the point's own, but for the slope within a pixel.
    found = looked_up(before.image(before.p)[..., 0], places[:, accepted])
    assert np.abs(found - now.p[accepted, 0]).max() < 5e-3
    # Ground that the cube hid before is not accepted.
    to_eye = before.camera.eye - now.p
    hidden = scene.tracer.blocked(
        (now.p + 1e-3 * now.n_g).astype(np.float32), to_eye.astype(np.float32)
    )
    assert hidden.any() and accepted[hidden].mean() < 0.2


def test_a_filter_keeps_its_own_side_s_history_along_an_edge(scene):
    """Bilinear where all four pixels show the surface, else of those that do."""
    before, now = (see_surface(scene, camera(shift), 120, 80) for shift in (0.0, 0.1))
    accepted, places = Reprojection(now, before).seen
    images = before.image(before.p).transpose(2, 0, 1)
    found, values = Reprojection(now, before).history(images)
    assert (found >= accepted).all() and found.mean() > accepted.mean() + 0.02
    inside = accepted[found]
    assert np.allclose(values[0][inside], looked_up(images[0], places[:, accepted]), atol=1e-5)
    # A pixel's width away at most, and never of the other side: the cube stands 0.25 from the ground's.
    assert np.abs(values - now.p[found].T).max() < 0.1
    # Ground that the cube hid is found by its rim alone, within a pixel of what was seen.
    before, now = (see_surface(scene, camera(shift), 480, 320) for shift in (0.0, 0.4))
    found, _ = Reprojection(now, before).history(before.image(before.p).transpose(2, 0, 1))
    to_eye = (before.camera.eye - now.p).astype(np.float32)
    hidden = scene.tracer.blocked((now.p + 1e-3 * now.n_g).astype(np.float32), to_eye)
    assert hidden.sum() > 500 and found[hidden].mean() < 0.1


def test_a_cubic_look_up_keeps_what_a_linear_one_blurs():
    """A parabola half-way between two pixels, far from the rim."""
    image = np.tile(np.arange(40.0) ** 2, (40, 1))
    places = np.array([[19.5, 20.5], [20.0, 20.0]])
    assert np.allclose(looked_up(image, places, 3), places[0] ** 2, atol=1e-2)
    assert np.allclose(looked_up(image, places), places[0] ** 2 + 0.25, atol=1e-2)


def test_a_moved_object_is_looked_up_where_it_was(scene):
    before = see_surface(scene, camera(), 240, 160)
    shifted = before.p + np.array([0.3, 0, 0], np.float32)
    accepted, places = Reprojection(before, before, was=before.p).seen
    assert accepted.mean() > 0.7
    column, _ = places
    moved_column, *_ = projected(camera(), 240, 160, shifted)
    assert np.abs(column - before.pixel % 240).max() < 1e-3
    assert np.abs(moved_column - column).min() > 1

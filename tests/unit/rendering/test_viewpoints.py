from dataclasses import asdict

import numpy as np
import pytest
import trimesh
from scipy.stats import kstest
from shapes import box, scene_of

from neural_shadows.rendering.exact_shadow import exact_visibility
from neural_shadows.rendering.gbuffer import render_gbuffer
from neural_shadows.rendering.viewpoints import draw_viewpoints, surface_points
from neural_shadows.scenes.cameras import VIEW_SETS

W, H = 150, 100
ARC = {"domain": "single_axis", "axis": "x", "min_elevation_deg": 20}


@pytest.fixture(scope="module")
def torus():
    return scene_of(trimesh.creation.torus(0.7, 0.3))


def draw(scene, view_sets, indices, seed=11):
    return draw_viewpoints(scene, view_sets, indices, W / H, seed)


@pytest.fixture(scope="module")
def views(torus):
    """Fifty of each set."""
    return {view_set: draw(torus, [view_set], range(50)) for view_set in ("shadow", "surface")}


def test_shadow_frames_are_filled_with_cast_shadow(torus, views):
    cast = []
    for view in views["shadow"]:
        frame = render_gbuffer(torus, view, W, H)
        dark = exact_visibility(torus.tracer, frame) == 0
        cast.append(np.count_nonzero(dark & ~frame.is_object) / (W * H))
        assert view.target[1] == pytest.approx(torus.ground, abs=1e-6)
        assert view.eye[1] > torus.ground + 0.1
    assert np.mean(cast) > 0.35 and np.quantile(cast, 0.2) > 0.2


def test_surface_frames_show_the_surface_in_their_middle(torus, views):
    covered = []
    for view in views["surface"]:
        frame = render_gbuffer(torus, view, W + 1, H + 1)  # odd: a pixel's centre
        (middle,) = np.flatnonzero(frame.pixel == (H // 2) * (W + 1) + W // 2)
        assert frame.is_object[middle]
        # It is the target, and not something before it; and it faces the light.
        (query,) = np.flatnonzero(frame.lit_side == middle)
        assert np.linalg.norm(frame.p[query] - view.target) < 2e-3
        covered.append(np.count_nonzero(frame.is_object) / ((W + 1) * (H + 1)))
        assert view.eye[1] > torus.ground and np.linalg.norm(view.eye) > 1
    assert np.mean(covered) > 0.4


def test_views_have_a_least_share_of_cast_shadow():
    # A low wall on a large plate: most lights and cameras see little of its shadow.
    wall = trimesh.util.concatenate([box(1.4, 0.02, 1.4), box(0.05, 0.3, 0.6)])
    scene = scene_of(wall, ground=False, light=ARC | {"axis": "z"})

    def shares(least):
        found = []
        for view in draw_viewpoints(scene, ["centre"], range(12), W / H, 5, least):
            frame = render_gbuffer(scene, view, W, H)
            dark = len(frame.lit_side) - np.count_nonzero(exact_visibility(scene.tracer, frame))
            found.append(dark / len(frame.pixel))
        return np.array(found)

    assert np.quantile(shares(0.0), 0.5) < 0.08
    assert shares(0.1).min() > 0.08  # judged by a picture of 24 rows


def test_surface_points_are_uniform_by_area():
    # Two triangles, of areas 1 : 3, apart from each other.
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 0, 1], [5, 0, 0], [8, 0, 0], [5, 0, 1]], float)
    scene = scene_of(trimesh.Trimesh(corners, [[0, 1, 2], [3, 4, 5]], process=False))
    points, normals = surface_points(scene, 8000, np.random.default_rng(2))
    np.testing.assert_array_equal(normals, np.tile([0.0, -1.0, 0.0], (8000, 1)))
    second = points[:, 0] > 2
    assert second.mean() == pytest.approx(0.75, abs=0.02)
    u, v = (points[second, 0] - 5) / 3, points[second, 2]
    # A weight w of a point uniform over a triangle exceeds x with probability (1 − x)².
    for weight in (u, v, 1 - u - v):
        assert kstest((1 - weight) ** 2, "uniform").pvalue > 1e-3


def test_centre_views_look_down_at_the_centre():
    scene = scene_of(trimesh.creation.torus(0.7, 0.3), ground=False, light=ARC)
    for view in draw(scene, ["centre"], range(50)):
        np.testing.assert_array_equal(view.target, 0)
        elevation = np.degrees(np.arcsin(view.eye[1] / np.linalg.norm(view.eye)))
        assert 20 <= elevation <= 70 and np.linalg.norm(view.eye) > 1
        assert view.light[0] == 0  # on the arc about x


def test_viewpoints_depend_on_seed_set_and_index_alone(torus, views):
    # In two batches, both sets at once, and in another order.
    expected = [views[view_set][index] for view_set in ("surface", "shadow") for index in (7, 3)]
    for a, b in zip(draw(torus, ["surface", "shadow"], [7, 3]), expected, strict=True):
        np.testing.assert_equal(asdict(a), asdict(b))
    assert (draw(torus, ["surface"], [7], seed=12)[0].eye != expected[0].eye).any()


@pytest.mark.parametrize("up", np.eye(3))
def test_every_axis_can_be_up(up):
    scene = scene_of(box(0.9, 1.0, 1.1), up=up)
    for view in draw(scene, VIEW_SETS, range(4)):
        assert view.eye @ up > scene.ground
        assert view.light @ up >= np.sin(np.radians(20))
        frame = render_gbuffer(scene, view, W, H)
        dark = exact_visibility(scene.tracer, frame) == 0
        shown = frame.is_object if view.view_set != "shadow" else dark & ~frame.is_object
        assert np.count_nonzero(shown) > 0.1 * W * H

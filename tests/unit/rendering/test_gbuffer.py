import numpy as np
import pytest
import trimesh
from shapes import AXES, Y_UP, box, bumpy_sphere, looking, prepared, sheet, unit

from neural_shadows.rendering.gbuffer import (
    GROUND_RADIUS,
    SHADING_OFFSET,
    ground_height,
    primary_hits,
)
from neural_shadows.rendering.shading import (
    AMBIENT,
    BACKGROUND,
    reference_visibility,
    shade,
    visibility,
)

W, H = 150, 100


@pytest.fixture(scope="module")
def sphere():
    return prepared(trimesh.creation.icosphere(5))


def test_sphere_covers_its_perspective_disc(sphere):
    view = looking((0, 0, 3), unit(0, 1, 1))
    points = primary_hits(*sphere, view, 600, 400, None)
    # Tangent rays leave at asin(1/3); the frame is 2 tan(fov/2) high.
    radius = np.tan(np.arcsin(1 / 3)) / np.tan(np.radians(22.5)) * 200
    assert points.is_object.all()
    assert len(points.pixel) == pytest.approx(np.pi * radius**2, rel=0.005)
    row, column = np.divmod(points.pixel, 600)
    assert row.mean() == pytest.approx(199.5, abs=0.5)
    assert column.mean() == pytest.approx(299.5, abs=0.5)


def test_picture_is_upright_and_not_mirrored():
    shape = box(0.2, 0.2, 0.2)
    shape.apply_translation([0.4, 0.3, 0])
    points = primary_hits(*prepared(shape), looking((0, 0, 3), unit(0, 1, 1)), W, H, None)
    row, column = np.divmod(points.pixel, W)
    scale = H / 2 / (3 * np.tan(np.radians(22.5)))  # pixels a unit at the target's distance
    assert column.mean() == pytest.approx(W / 2 + 0.4 * scale, abs=1.5)
    assert row.mean() == pytest.approx(H / 2 - 0.3 * scale, abs=1.5)


def test_points_lie_off_the_surface_by_the_offset():
    cube = prepared(box(1, 1, 1))
    points = primary_hits(*cube, looking((1.5, 2, 2.5), unit(2, 3, 4)), W, H, None)
    assert len(points.facing) == len(points.pixel) > 1000
    outermost = np.abs(points.p).max(axis=1)
    np.testing.assert_allclose(outermost, 0.5 + SHADING_OFFSET, atol=2e-7)
    # The camera sees three faces, each with its own angle to the light.
    expected = np.sort(unit(2, 3, 4))
    np.testing.assert_allclose(np.unique(points.cos_theta.round(5)), expected, atol=1e-5)


def test_normals_are_interpolated(sphere):
    light = unit(1, 1, 1)
    coarse = prepared(trimesh.creation.icosphere(3))
    points = primary_hits(*coarse, looking((0, 0, 3), light), W, H, None)
    exact = np.maximum(points.p / np.linalg.norm(points.p, axis=1, keepdims=True) @ light, 0)
    # On facets of 8 degrees flat normals are wrong by up to 0.07.
    assert np.abs(points.cosine - exact).max() < 5e-3
    assert np.abs(points.cos_theta - exact).max() > 0.04


def test_points_turned_from_the_light_are_not_asked_for(sphere):
    light = unit(1, 0, 0.2)
    view = looking((0, 0, 3), light)
    points = primary_hits(*sphere, view, W, H, None)
    assert (points.cos_theta > 0).all()
    away = np.setdiff1d(np.arange(len(points.pixel)), points.facing)
    assert 0 < len(away) < len(points.pixel)
    everything = shade(points, np.ones(len(points.facing), bool))
    np.testing.assert_array_equal(everything.ravel()[points.pixel[away]], np.float32(AMBIENT))
    lit_column = points.pixel[points.facing] % W
    assert lit_column.mean() > W / 2  # the light comes from the right
    visible = visibility(points, np.ones(len(points.facing), bool))
    assert np.count_nonzero(visible) == len(points.facing)
    assert not visible[away].any()


@pytest.mark.parametrize("winding", [1, -1])
def test_both_sides_of_a_sheet_are_shaded(winding):
    mesh = prepared(sheet(0.0, 0.7, winding))
    light = unit(0.3, 1, 0)
    points = primary_hits(*mesh, looking((0.5, 2, 2), light), W, H, None)
    assert len(points.facing) == len(points.pixel) > 100
    np.testing.assert_allclose(points.p[:, 1], SHADING_OFFSET, atol=1e-7)
    np.testing.assert_allclose(points.cosine, light[1], atol=1e-6)
    assert reference_visibility(mesh[1], points).all()
    # From below, the side seen is turned from the light.
    below = primary_hits(*mesh, looking((0.5, -2, 2), light), W, H, None)
    assert len(below.pixel) > 100 and len(below.facing) == 0


@pytest.mark.parametrize("light", AXES)
def test_faces_edge_on_to_the_light_are_dark(light):
    """Of the three faces that are seen of a box one at most is lit, and the others are edge-on."""
    mesh, tracer = prepared(box(1, 1, 1))
    points = primary_hits(mesh, tracer, looking((1.5, 2, 2.5), light), W, H, None)
    assert len(points.pixel) > 1000
    if light.sum() < 0:  # it comes from behind them
        assert len(points.facing) == 0
        return
    assert 200 < len(points.facing) < len(points.pixel) / 2
    np.testing.assert_allclose(points.p @ light, 0.5 + SHADING_OFFSET, atol=2e-7)
    assert (points.cos_theta == 1).all()
    lit = reference_visibility(tracer, points)
    assert lit.all()
    image = shade(points, lit).ravel()[points.pixel]
    assert np.count_nonzero(image != np.float32(AMBIENT)) == len(points.facing)


@pytest.mark.parametrize("light", [unit(0, 1, 0), unit(1, 1, 0.5), unit(-3, 1.5, 1)])
def test_shadow_of_a_sphere_lies_where_it_must(sphere, light):
    mesh, tracer = sphere
    ground = ground_height(mesh, Y_UP)
    assert ground == pytest.approx(-1, abs=1e-6)
    middle = -light / light[1]
    view = looking(middle + (4, 3, 4), light, target=middle, fov=30)
    points = primary_hits(mesh, tracer, view, 300, 200, ground)
    lit = reference_visibility(tracer, points)
    on_ground = ~points.is_object[points.facing]
    p = points.p[on_ground].astype(float)
    np.testing.assert_allclose(p[:, 1], -1 + SHADING_OFFSET, atol=1e-5)
    from_axis = np.linalg.norm(p - (p @ light)[:, None] * light, axis=1)
    wrong = lit[on_ground] != (from_axis > 1)
    assert np.count_nonzero(from_axis < 1) > 1000
    assert np.count_nonzero(wrong) < 0.001 * len(p)
    assert np.abs(from_axis[wrong] - 1).max(initial=0) < 2e-3  # the facets' depth below the sphere


def test_shades_are_the_stated_ones(sphere):
    mesh, tracer = sphere
    light = unit(1, 1, 0)
    view = looking((0, 1, 6), light, target=(-1.5, -0.5, 0), fov=60)
    points = primary_hits(mesh, tracer, view, W, H, ground_height(mesh, Y_UP))
    lit = reference_visibility(tracer, points)
    image = shade(points, lit)
    assert image.shape == (H, W) and image.dtype == np.float32
    assert image.min() >= 0 and image.max() <= 1
    flat = image.ravel()
    sky = np.setdiff1d(np.arange(W * H), points.pixel)
    assert len(sky) > 100 and (flat[sky] == np.float32(BACKGROUND)).all()
    visible = visibility(points, lit)
    ground = ~points.is_object
    np.testing.assert_allclose(
        flat[points.pixel[ground & visible]], 0.25 + 0.75 * np.sqrt(0.5), atol=1e-6
    )
    assert (flat[points.pixel[ground & ~visible]] == np.float32(0.25)).sum() > 50
    np.testing.assert_array_equal(
        shade(points, np.zeros(len(lit), bool)).ravel()[points.pixel], 0.25
    )


def test_ground_ends_at_its_radius():
    mesh, tracer = prepared(bumpy_sphere(2))
    ground = ground_height(mesh, Y_UP)
    points = primary_hits(mesh, tracer, looking((0, 0.5, 3), Y_UP), W, H, ground)
    foot = np.array([0, ground, 0])
    reach = np.linalg.norm(points.p - foot, axis=1)
    assert 0.8 * GROUND_RADIUS < reach.max() < GROUND_RADIUS + 0.01
    row = points.pixel[~points.is_object] // W
    assert row.min() > 0 and row.max() == H - 1  # a horizon, and ground down to the lower edge


def test_ground_follows_the_up_axis():
    shape = box(1, 1, 0.5)
    mesh, tracer = prepared(shape)
    up = np.array([0.0, 0.0, 1.0])
    assert ground_height(mesh, up) == -0.25
    view = looking((2, -3, 2), unit(1, 0, 2))
    view = type(view)("surface", 0, view.eye, view.target, up, view.fov, view.light)
    points = primary_hits(mesh, tracer, view, W, H, -0.25)
    ground = points.p[~points.is_object[points.facing]]
    np.testing.assert_allclose(ground[:, 2], -0.25 + SHADING_OFFSET, atol=1e-5)


def test_a_frame_without_anything_is_all_background(sphere):
    mesh, tracer = sphere
    view = looking((0, 3, 3), Y_UP, target=(0, 6, 6))
    points = primary_hits(mesh, tracer, view, W, H, None)
    lit = reference_visibility(tracer, points)
    assert len(points.pixel) == len(lit) == 0
    assert (shade(points, lit) == np.float32(BACKGROUND)).all()

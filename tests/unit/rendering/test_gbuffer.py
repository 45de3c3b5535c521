import numpy as np
import pytest
import trimesh
from shapes import Y_UP, box, bumpy_sphere, looking, scene_of, sheet, unit

from neural_shadows.rendering.gbuffer import GROUND_RADIUS, SHADING_OFFSET, render_gbuffer

W, H = 150, 100


def test_sphere_covers_its_perspective_disc():
    sphere = scene_of(trimesh.creation.icosphere(5), ground=False)
    frame = render_gbuffer(sphere, looking((0, 0, 3), unit(0, 1, 1)), 600, 400)
    # Tangent rays leave at asin(1/3); the frame is 2 tan(fov/2) high.
    radius = np.tan(np.arcsin(1 / 3)) / np.tan(np.radians(22.5)) * 200
    assert frame.is_object.all()
    assert len(frame.pixel) == pytest.approx(np.pi * radius**2, rel=0.005)
    # Points that are turned from the light are not asked for.
    assert (frame.cos_geometric > 0).all() and 0 < len(frame.p) < len(frame.pixel)


def test_picture_is_upright_and_not_mirrored():
    shape = box(0.2, 0.2, 0.2)
    shape.apply_translation([0.4, 0.3, 0])
    frame = render_gbuffer(scene_of(shape, ground=False), looking((0, 0, 3), unit(0, 1, 1)), W, H)
    row, column = np.divmod(frame.pixel, W)
    scale = H / 2 / (3 * np.tan(np.radians(22.5)))  # pixels a unit at the target's distance
    assert column.mean() == pytest.approx(W / 2 + 0.4 * scale, abs=1.5)
    assert row.mean() == pytest.approx(H / 2 - 0.3 * scale, abs=1.5)


def test_points_lie_off_the_surface_by_the_offset():
    cube = scene_of(box(1, 1, 1), ground=False)
    frame = render_gbuffer(cube, looking((1.5, 2, 2.5), unit(2, 3, 4)), W, H)
    assert len(frame.lit_side) == len(frame.pixel) > 1000
    outermost = np.abs(frame.p).max(axis=1)
    np.testing.assert_allclose(outermost, 0.5 + SHADING_OFFSET, atol=2e-7)
    # The camera sees three faces, each with its own angle to the light.
    expected = np.sort(unit(2, 3, 4))
    np.testing.assert_allclose(np.unique(frame.cos_geometric.round(5)), expected, atol=1e-5)


def test_normals_are_interpolated():
    light = unit(1, 1, 1)
    coarse = scene_of(trimesh.creation.icosphere(3), ground=False)
    frame = render_gbuffer(coarse, looking((0, 0, 3), light), W, H)
    exact = np.maximum(frame.p / np.linalg.norm(frame.p, axis=1, keepdims=True) @ light, 0)
    # On facets of 8 degrees flat normals are wrong by up to 0.07.
    assert np.abs(frame.cos_shading - exact).max() < 5e-3
    assert np.abs(frame.cos_geometric - exact).max() > 0.04


@pytest.mark.parametrize("winding", [1, -1])
def test_both_sides_of_a_sheet_are_shaded(winding):
    scene = scene_of(sheet(0.0, 0.7, winding), ground=False)
    light = unit(0.3, 1, 0)
    frame = render_gbuffer(scene, looking((0.5, 2, 2), light), W, H)
    assert len(frame.lit_side) == len(frame.pixel) > 100
    np.testing.assert_allclose(frame.p[:, 1], SHADING_OFFSET, atol=1e-7)
    np.testing.assert_allclose(frame.cos_shading, light[1], atol=1e-6)
    # From below, the side seen is turned from the light.
    assert len(render_gbuffer(scene, looking((0.5, -2, 2), light), W, H).lit_side) == 0


def test_a_face_turned_over_is_shaded_as_its_neighbours():
    plate = box(1, 0.1, 1).subdivide().subdivide()
    right = scene_of(plate, ground=False)
    faces = plate.faces.copy()
    top = np.flatnonzero(plate.face_normals[:, 1] > 0.9)[::7]
    faces[top] = faces[top, ::-1]
    # As a scan has them: its vertices' normals are those of the surface around the face.
    turned = trimesh.Trimesh(plate.vertices, faces, process=False)
    turned.vertex_normals = plate.vertex_normals
    view = looking((0.5, 2, 2), unit(0.3, 1, 0.2))
    frames = [render_gbuffer(one, view, W, H) for one in (right, scene_of(turned, ground=False))]
    assert len(top) > 3 and len(frames[0].p) > 1000
    np.testing.assert_allclose(frames[1].cos_shading, frames[0].cos_shading, atol=1e-6)


def test_ground_ends_at_its_radius():
    scene = scene_of(bumpy_sphere(2))
    frame = render_gbuffer(scene, looking((0, 0.5, 3), Y_UP), W, H)
    reach = np.linalg.norm(frame.p - np.array([0, scene.ground, 0]), axis=1)
    assert 0.8 * GROUND_RADIUS < reach.max() < GROUND_RADIUS + 0.01
    row = frame.pixel[~frame.is_object] // W
    assert row.min() > 0  # a horizon

"""The stand-in dragon: its primitives against exact distances, its mesh against what is asked."""

import numpy as np
import pytest
import trimesh

from neural_shadows.errors import InputError
from neural_shadows.meshes.wyrm import Part, cones, distance_grid, ellipsoid, make_wyrm


@pytest.fixture(scope="module")
def wyrm():
    return trimesh.Trimesh(*make_wyrm(), process=False)


def sampled(parts, cells=60):
    """Distance grid of the parts with the coordinates (..., 3) of its samples, and the cell."""
    grid, origin, cell = distance_grid(parts, cells)
    return grid, origin + cell * np.stack(np.indices(grid.shape), axis=-1), cell


def assert_near_surface(grid, exact, cell):
    near = np.abs(exact) < 2 * cell
    assert near.sum() > 1000
    np.testing.assert_allclose(grid[near], exact[near], atol=1e-5)


def test_cone_of_constant_radius_is_a_capsule():
    grid, points, cell = sampled([cones(np.array([[0, 0, 0, 0.3], [2, 0, 0, 0.3]]), 0.01)])
    nearest = np.clip(points[..., 0], 0, 2)[..., None] * [1, 0, 0]
    assert_near_surface(grid, np.linalg.norm(points - nearest, axis=-1) - 0.3, cell)


def test_wedge_is_the_distance_to_its_triangle_less_the_half_thickness():
    corners = np.array([[0.0, 0, 0], [2, 0.3, 0], [0.5, 1, 0.7]])
    grid, points, cell = sampled([Part(np.c_[corners, [0.2, 0.2, 0.2]][None], 0.01)])
    flat = points.reshape(-1, 3)
    triangles = np.broadcast_to(corners, (len(flat), 3, 3))
    nearest = trimesh.triangles.closest_point(triangles, flat)
    exact = np.linalg.norm(flat - nearest, axis=1).reshape(grid.shape) - 0.2
    assert_near_surface(grid, exact, cell)


def test_ellipsoid_is_negative_just_inside():
    grid, points, _ = sampled([ellipsoid((0.1, 0.2, 0.3), (1.0, 0.5, 0.3), 0.01)])
    quadric = (((points - [0.1, 0.2, 0.3]) / [1.0, 0.5, 0.3]) ** 2).sum(axis=-1)
    off = np.abs(quadric - 1) > 1e-5  # on the surface the sign is float32's rounding
    np.testing.assert_array_equal(grid[off] < 0, quadric[off] < 1)


def test_smooth_union_adds_a_quarter_of_the_blend_where_two_parts_are_equally_far():
    balls = [ellipsoid((x, 0, 0), (0.5, 0.5, 0.5), 0.2) for x in (-0.48, 0.48)]
    grid, points, cell = sampled(balls, cells=100)
    middle = np.abs(points[..., 0]) < 1e-6
    assert middle.any()
    apart = np.linalg.norm(points[middle] - [0.48, 0, 0], axis=-1) - 0.5
    near = np.abs(apart) < 2 * cell
    np.testing.assert_allclose(grid[middle][near], apart[near] - 0.05, atol=1e-5)


def test_carved_part_is_taken_away():
    ball = ellipsoid((0, 0, 0), (1, 1, 1), 0.01)
    grid, points, _ = sampled([ball, ellipsoid((1, 0, 0), (0.4, 0.4, 0.4), 0.01, carve=True)])
    hole = np.linalg.norm(points - [1, 0, 0], axis=-1)
    inside = np.linalg.norm(points, axis=-1) < 0.9
    assert (grid[hole < 0.35] > 0).all()
    assert (grid[inside & (hole > 0.45)] < 0).all()


def test_part_thinner_than_a_cell_is_thickened_to_stay_whole():
    grid, points, cell = sampled([cones(np.array([[0, 0, 0, 1e-4], [2, 1, 0.7, 1e-4]]), 0.01)])
    inside = points[grid < 0]
    along = np.sort(inside @ np.array([2, 1, 0.7])) / np.linalg.norm([2, 1, 0.7])
    assert np.diff(along).max() < cell


def test_is_closed_outward_and_one_piece_in_single_precision(wyrm):
    """PLY files hold float32: no two vertices may fall together there."""
    rounded = trimesh.Trimesh(wyrm.vertices.astype(np.float32), wyrm.faces, process=True)
    assert rounded.is_watertight and rounded.is_winding_consistent and rounded.volume > 0.1
    assert rounded.body_count == 1 and len(rounded.vertices) == len(wyrm.vertices)
    assert rounded.nondegenerate_faces().all()


def test_default_has_the_promised_size(wyrm):
    assert 100_000 <= len(wyrm.faces) <= 250_000
    assert np.argmax(wyrm.extents) == 0


def test_same_bytes_twice():
    assert [a.tobytes() for a in make_wyrm(64)] == [a.tobytes() for a in make_wyrm(64)]


@pytest.mark.parametrize("x, z", [(-0.33, 0.24), (-0.21, -0.24), (0.39, 0.23), (0.23, -0.23)])
def test_every_foot_stands_on_the_ground(wyrm, x, z):
    assert wyrm.bounds[0, 1] == 0
    under = np.hypot(wyrm.vertices[:, 0] - x, wyrm.vertices[:, 2] - z) < 0.2
    assert wyrm.vertices[under, 1].min() < 0.01 * wyrm.scale


def test_rejects_too_few_cells():
    with pytest.raises(InputError, match="cells is 16"):
        make_wyrm(16)

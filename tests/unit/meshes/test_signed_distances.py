"""Signed distances to primitives against exact ones."""

import numpy as np
import trimesh

from neural_shadows.meshes.signed_distances import Part, distance_grid
from neural_shadows.meshes.wyrm import cones, ellipsoid


def sampled(parts, cells=60):
    """Distance grid of the parts with the coordinates (..., 3) of its samples, and the cell."""
    grid, origin, cell = distance_grid(parts, cells)
    return grid, origin + cell * np.stack(np.indices(grid.shape), axis=-1), cell


def test_capsules_and_wedges_near_their_surface():
    corners = np.array([[0.0, 0, 0], [2, 0.3, 0], [0.5, 1, 0.7]])
    for part, flat, radius in [
        (cones(np.array([[0, 0, 0, 0.3], [2, 0, 0, 0.3]]), 0.01), [[0, 0, 0], [2, 0, 0]] * 2, 0.3),
        (Part(np.c_[corners, [0.2, 0.2, 0.2]][None], 0.01), corners, 0.2),
    ]:
        grid, points, cell = sampled([part])
        points = points.reshape(-1, 3)
        triangles = np.broadcast_to(flat[:3], (len(points), 3, 3))
        nearest = trimesh.triangles.closest_point(triangles, points)
        exact = np.linalg.norm(points - nearest, axis=1).reshape(grid.shape) - radius
        near = np.abs(exact) < 2 * cell
        assert near.sum() > 1000
        np.testing.assert_allclose(grid[near], exact[near], atol=1e-5)


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

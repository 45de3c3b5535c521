"""Fitted distances: convex edges, and the fitted surface."""

import numpy as np
import pytest
import trimesh
from shapes import box, octahedron, prepared

from neural_shadows.representations.distance_bricks.brick_distances import signed_distances
from neural_shadows.representations.distance_bricks.brick_layout import BrickLayout, lay_out
from neural_shadows.representations.distance_bricks.surface_fit import (
    convex_edges,
    fitted_distances,
)
from neural_shadows.representations.voxels.occupancy import surface_cells

BRICKS = 8
HALF = 2 * BRICKS  # cells in a radius


def pyramid() -> trimesh.Trimesh:
    rim = [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]
    faces = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [0, 2, 1], [0, 3, 2]]
    return trimesh.Trimesh(np.array([*rim, [0, 0, 0.5]]) * 0.5, faces, process=False)


def test_a_box_has_twelve_edges_and_a_missing_face_leaves_half_turns():
    ends, angles = convex_edges(prepared(box(1, 1, 1))[0])
    sharp = angles > 1e-3  # the diagonals of its sides are flat
    assert sharp.sum() == 12
    assert np.allclose(angles[sharp], np.pi / 2, atol=1e-3)
    ends, angles = convex_edges(prepared(octahedron())[0])
    assert len(ends) == 12
    assert np.allclose(angles, np.arccos(1 / 3), atol=1e-3)
    shape = octahedron()
    shape.update_faces(np.arange(8) > 0)
    ends, angles = convex_edges(prepared(shape)[0])
    assert np.isclose(angles, np.pi).sum() == 3


def test_edges_that_no_ray_touches_are_left_out():
    """A pyramid and, turned inside out, the same as a pit."""
    shape = pyramid()
    _, outer = convex_edges(prepared(shape)[0])
    pit = trimesh.Trimesh(shape.vertices, shape.faces[:, ::-1], process=False)
    _, inner = convex_edges(prepared(pit)[0])
    assert (outer > 1e-3).sum() == 8
    assert (inner > 1e-3).sum() == 0


def interpolated(layout: BrickLayout, values: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Values at places (n, 3) in cells, corner by corner."""
    whole = np.full((4 * BRICKS + 1,) * 3, np.nan)
    whole[tuple(layout.vertices.T)] = values
    cell = np.floor(points).astype(int)
    total = np.zeros(len(points))
    for corner in np.ndindex(2, 2, 2):
        share = np.abs(1 - np.array(corner) - (points - cell)).prod(axis=1)
        total += share * whole[tuple((cell + corner).T)]
    return total


@pytest.fixture(scope="module")
def ball():
    """A ball 8 cells in radius, its layout and signed distances."""
    mesh, _ = prepared(trimesh.creation.icosphere(5, radius=0.5))
    layout = lay_out(surface_cells(mesh.vertices, mesh.faces, BRICKS), True)
    return mesh, layout, signed_distances(mesh, layout)


def test_the_surface_of_a_ball(ball):
    """Interpolation cuts a ball of radius r off by up to 1/(4 r) cells; the fit does not."""
    mesh, layout, distances = ball
    directions = np.random.default_rng(0).normal(size=(2000, 3))
    points = directions / np.linalg.norm(directions, axis=1, keepdims=True) * 0.5 * HALF + HALF
    before = interpolated(layout, distances, points)
    after = interpolated(layout, fitted_distances(mesh, layout, distances), points)
    assert -1 / (4 * 8) < before.mean() < -0.01
    assert abs(after.mean()) < 0.003
    assert np.abs(after).mean() < 0.5 * np.abs(before).mean()


def test_far_distances_are_unchanged(ball):
    """Vertices of cells without the surface keep their distances, moved out by as much as all."""
    mesh, layout, distances = ball
    far = np.abs(distances) > 1.9
    moved = fitted_distances(mesh, layout, distances) - distances
    assert far.any()
    assert np.allclose(moved[far], 0.05, atol=1e-6)

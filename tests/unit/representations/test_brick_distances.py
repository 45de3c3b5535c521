"""Signed distances of brick vertices against a ball and a box."""

import numpy as np
import pytest
import trimesh
from shapes import box, prepared

from neural_shadows.representations.distance_bricks.brick_distances import inside, signed_distances
from neural_shadows.representations.distance_bricks.brick_layout import lay_out
from neural_shadows.representations.voxels.occupancy import surface_cells

BRICKS, REACH = 8, 2.0
CELL = 2 / (4 * BRICKS)


def distances_of(shape: trimesh.Trimesh) -> tuple[np.ndarray, np.ndarray]:
    """Positions (count, 3) of the vertices, and their distances in cells."""
    mesh, _ = prepared(shape)
    layout = lay_out(surface_cells(mesh.vertices, mesh.faces, BRICKS), True)
    return layout.vertices * CELL - 1, signed_distances(mesh, layout)


def test_a_box(angle=0.3):
    """Turned, so that faces, edges and corners are all nearest to some vertex."""
    turn = trimesh.transformations.rotation_matrix(angle, [1, 2, 3])
    positions, distances = distances_of(box(0.7, 0.9, 1.1).apply_transform(turn))
    q = np.abs(positions @ turn[:3, :3]) - [0.35, 0.45, 0.55]
    outside = np.linalg.norm(np.maximum(q, 0), axis=1)
    expected = -(outside + np.minimum(q.max(1), 0)) / CELL
    assert np.abs(distances - expected.clip(-REACH, REACH)).max() < 1e-5
    assert (np.abs(expected) > REACH).any() and (np.abs(expected) < 0.5).any()


@pytest.mark.parametrize("hole", [0, 8])
def test_a_ball_with_a_hole_has_an_inside(hole):
    """Through a hole of some triangles few rays of a point leave."""
    shape = trimesh.creation.icosphere(4, radius=0.5)
    shape.update_faces(np.arange(len(shape.faces)) >= hole)
    positions, distances = distances_of(shape)
    depth = 0.5 - np.linalg.norm(positions, axis=1)
    clear = np.abs(depth) > 0.01
    assert ((distances > 0) == (depth > 0))[clear].all()
    assert 0.2 < (distances > 0).mean() < 0.8


def test_nothing_is_inside_a_mesh_that_is_turned_inside_out():
    shape = trimesh.creation.icosphere(2)
    points = np.random.default_rng(0).uniform(-0.4, 0.4, (100, 3)).astype(np.float32)
    assert inside(prepared(shape)[0], points).all()
    turned = trimesh.Trimesh(shape.vertices, shape.faces[:, ::-1], process=False)
    assert not inside(prepared(turned)[0], points).any()

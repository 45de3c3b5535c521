"""Cells of an occupancy grid against planes, boxes and the distance to triangles."""

import numpy as np
import pytest
import trimesh

from neural_shadows.networks.object_space.occupancy import enclosed_cells, surface_cells


def random_triangles(count: int, size: float) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(1)
    corners = rng.uniform(-0.7, 0.7, (count, 1, 3)) + rng.uniform(-size, size, (count, 3, 3))
    return corners.reshape(-1, 3), np.arange(3 * count).reshape(-1, 3)


def centres(n: int) -> np.ndarray:
    axis = (np.arange(n) + 0.5) / n * 2 - 1
    return np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), axis=-1)


def test_a_plane_across_an_axis_is_one_layer():
    vertices = np.array([[-0.9, 0.1, -0.9], [0.9, 0.1, -0.9], [0.9, 0.1, 0.9], [-0.9, 0.1, 0.9]])
    cells = surface_cells(vertices, np.array([[0, 1, 2], [0, 2, 3]]), 10)
    expected = np.zeros((10, 10, 10), bool)
    expected[:, 5, :] = True  # [0, 0.2)
    assert np.array_equal(cells, expected)


@pytest.mark.parametrize("size", [0.02, 0.3])
def test_every_point_of_the_surface_is_in_a_marked_cell(size):
    vertices, faces = random_triangles(200, size)
    cells = surface_cells(vertices, faces, 24)
    weights = np.random.default_rng(2).dirichlet([1, 1, 1], (len(faces), 500))
    points = np.einsum("fpk,fkd->fpd", weights, vertices[faces]).reshape(-1, 3)
    x, y, z = np.floor((points + 1) / 2 * 24).astype(int).T
    assert cells[x, y, z].all()


@pytest.mark.parametrize("size", [0.02, 0.3])
def test_no_cell_away_from_the_surface_is_marked(size):
    """A cell is touched only if the distance from its centre, by the largest axis, is half a side."""
    vertices, faces = random_triangles(200, size)
    marked = centres(24)[surface_cells(vertices, faces, 24)]
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    _, distance, _ = trimesh.proximity.closest_point_naive(mesh, marked)
    assert (distance <= np.sqrt(3) / 24 * 1.01).all()
    # The bounding boxes' cells would be more: the long diagonal's alone are many times as many.
    low, high = vertices[faces].min(axis=1), vertices[faces].max(axis=1)
    boxes = np.zeros((24, 24, 24), bool)
    for a, b in zip(np.floor((low + 1) * 12).astype(int), np.floor((high + 1) * 12).astype(int)):
        boxes[a[0] : b[0] + 1, a[1] : b[1] + 1, a[2] : b[2] + 1] = True
    assert len(marked) <= boxes.sum()
    if size == 0.3:
        assert len(marked) < 0.8 * boxes.sum()


def test_the_inside_of_a_sphere_is_enclosed():
    sphere = trimesh.creation.icosphere(4, radius=0.8)
    surface = surface_cells(sphere.vertices, sphere.faces, 20)
    inside = enclosed_cells(surface)
    distance = np.linalg.norm(centres(20), axis=-1)
    assert not (inside & surface).any()
    assert inside[distance < 0.8 - 0.1].all() and not inside[distance > 0.8].any()


def test_a_small_hole_does_not_open_the_inside_and_a_large_one_does():
    sphere = trimesh.creation.icosphere(4, radius=0.8)
    for share, closed in ((1, True), (150, False)):
        order = np.argsort(sphere.triangles_center[:, 1])
        surface = surface_cells(sphere.vertices, sphere.faces[order[share:]], 20)
        assert enclosed_cells(surface)[10, 10, 10] == closed

"""Occupancy cells against planes, boxes and triangle distances."""

import numpy as np
import pytest
import trimesh

from neural_shadows.representations.voxels.occupancy import enclosed_cells, surface_cells


def random_triangles(count: int, size: float) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(1)
    corners = rng.uniform(-0.7, 0.7, (count, 1, 3)) + rng.uniform(-size, size, (count, 3, 3))
    return corners.reshape(-1, 3), np.arange(3 * count).reshape(-1, 3)


def centres(n: int) -> np.ndarray:
    axis = (np.arange(n) + 0.5) / n * 2 - 1
    return np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), axis=-1)


@pytest.mark.parametrize("size", [0.02, 0.3])
def test_cells_are_those_that_a_triangle_touches(size):
    vertices, faces = random_triangles(200, size)
    cells = surface_cells(vertices, faces, 24)
    weights = np.random.default_rng(2).dirichlet([1, 1, 1], (len(faces), 500))
    points = np.einsum("fpk,fkd->fpd", weights, vertices[faces]).reshape(-1, 3)
    x, y, z = np.floor((points + 1) / 2 * 24).astype(int).T
    assert cells[x, y, z].all()
    # And no others: a cell's corner is half its diagonal from its centre.
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    _, distance, _ = trimesh.proximity.closest_point_naive(mesh, centres(24)[cells])
    assert (distance <= np.sqrt(3) / 24 * 1.01).all()


@pytest.mark.parametrize(("hole", "closed"), [(0, True), (1, True), (150, False)])
def test_the_inside_of_a_sphere_is_enclosed_unless_its_hole_is_large(hole, closed):
    sphere = trimesh.creation.icosphere(4, radius=0.8)
    order = np.argsort(sphere.triangles_center[:, 1])
    surface = surface_cells(sphere.vertices, sphere.faces[order[hole:]], 20)
    inside = enclosed_cells(surface)
    distance = np.linalg.norm(centres(20), axis=-1)
    assert not (inside & surface).any() and not inside[distance > 0.8].any()
    assert inside[distance < 0.8 - 0.1].all() == closed

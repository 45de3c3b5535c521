"""Distances of brick corners to a field's surface."""

import numpy as np
import trimesh
from shapes import prepared

from neural_shadows.evaluation.method_parts.object_field import fitted_field
from neural_shadows.representations.distance_bricks.distances_around import distances_around
from neural_shadows.representations.distance_bricks.field_marching import SOLID


def test_of_a_sphere():
    field = fitted_field(prepared(trimesh.creation.icosphere(5))[0], 0.04)
    around = distances_around(field.grid, field.bricks)
    size = len(field.grid)
    points = (np.indices((size + 1,) * 3) * (2 / size) - 1).reshape(3, -1)
    exact = np.linalg.norm(points, axis=0) - 1 / field.radius
    assert around.shape == (size + 1,) * 3 and np.mean(exact < 0) > 0.2
    away = np.abs(around.ravel() - exact) * field.resolution / 2  # in cells
    assert away.max() < 0.6 and away.mean() < 0.15


def test_a_wall_on_the_border_of_bricks():
    """Its bricks hold nothing but what is inside; those beyond are empty, or enclosed by others."""
    field = fitted_field(prepared(trimesh.creation.box((2, 2, 2)))[0], 0.1)
    grid, bricks = field.grid.copy(), field.bricks.copy()
    size = len(grid)
    grid[:], bricks[:] = -1, 100
    grid[2 : size - 2, 2 : size - 2, 2 : size - 2] = SOLID
    wall = np.zeros_like(grid, bool)
    wall[2 : size - 2, 2 : size - 2, 2] = True
    grid[wall] = np.arange(wall.sum())
    around = distances_around(grid, bricks[: wall.sum()])
    middle = around[size // 2, size // 2] * size / 2  # in bricks
    assert np.allclose(middle[:5], [2, 1, 0, -1, -2], atol=1e-6)

"""Distances from bricks' corners to the surface of a field."""

import numpy as np
import trimesh
from shapes import prepared

from neural_shadows.evaluation.soft_methods.object_fields import ObjectField
from neural_shadows.networks.object_space.distances_around import distances_around


def test_of_a_sphere():
    field = ObjectField(prepared(trimesh.creation.icosphere(5))[0], 0.04)
    around = distances_around(field.grid, field.bricks)
    size = len(field.grid)
    places = (np.indices((size + 1,) * 3) * (2 / size) - 1).reshape(3, -1)
    exact = np.linalg.norm(places, axis=0) - 1 / field.radius
    assert around.shape == (size + 1,) * 3 and np.mean(exact < 0) > 0.2
    away = np.abs(around.ravel() - exact) * field.resolution / 2  # in cells
    assert away.max() < 0.6 and away.mean() < 0.15

"""Random points on a mesh: their distribution in closed form."""

import numpy as np
import pytest
from scipy.stats import kstest

from neural_shadows.meshes.uniform_points import uniform_points


def test_points_are_uniform_by_area():
    """On two triangles of areas 1 : 3; a face without area, last, has none."""
    corners = [[0, 0, 0], [1, 0, 0], [0, 0, 1], [5, 0, 0], [8, 0, 0], [5, 0, 1]]
    faces = np.array([[0, 1, 2], [3, 4, 5], [0, 1, 1]])
    points, face = uniform_points(np.float32(corners), faces, 8000, np.random.default_rng(2))
    assert points.shape == (8000, 3) and set(face) == {0, 1}
    second = face == 1
    assert second.mean() == pytest.approx(0.75, abs=0.02)
    assert np.array_equal(second, points[:, 0] > 2)
    u, v = (points[second, 0] - 5) / 3, points[second, 2]
    # A weight w of a point uniform over a triangle exceeds x with probability (1 − x)².
    for weight in (u, v, 1 - u - v):
        assert kstest((1 - weight) ** 2, "uniform").pvalue > 1e-3

"""The minimal enclosing sphere against analytic answers and its certificate."""

from itertools import product

import numpy as np
import pytest
from scipy.optimize import nnls

from neural_shadows.meshes.bounding_sphere import minimal_bounding_sphere

CUBE = np.array(list(product((-1.0, 1.0), repeat=3)))


def on_sphere(n):
    points = np.random.default_rng(0).normal(size=(n, 3))
    return points / np.linalg.norm(points, axis=1, keepdims=True)


@pytest.mark.parametrize(
    ("points", "centre", "radius"),
    [
        ([[3, -4, 5]] * 7, [3, -4, 5], 0),
        ([[0, 0, 0], [2, 4, 4]], [1, 2, 2], 3),
        (np.vstack([CUBE, 0.9 * on_sphere(100)]), [0, 0, 0], np.sqrt(3)),
        # obtuse: the longest side is a diameter
        ([[0, 0, 0], [10, 0, 0], [4, 1, 0]], [5, 0, 0], 5),
        # an acute triangle, whose circumcentre is neither its box's nor its centroid
        ([[-1, 0, 0], [1, 0, 0], [0, 2, 0], [0, 1, 0]], [0, 0.75, 0], 1.25),
        # collinear, in no order
        (np.outer([0.3, -1, 0, 1, 0.3, 0.99], [2, 3, 6]), [0, 0, 0], 7),
    ],
)
def test_analytic(points, centre, radius):
    for unit in (1, 1e-200):
        found_centre, found_radius = minimal_bounding_sphere(np.array(points) * unit)
        assert found_centre / unit == pytest.approx(centre, abs=1e-14)
        assert found_radius / unit == pytest.approx(radius, rel=1e-14)


def touching_points(points, centre, radius):
    """Those on the minimal sphere: its centre is a convex combination of them, and none is outside."""
    away = (points - centre) / radius
    distances = np.linalg.norm(away, axis=1)
    assert distances.max() <= 1 + 1e-12
    touching = away[distances > 1 - 1e-12]
    system = np.vstack([touching.T, np.ones(len(touching))])
    assert nnls(system, [0, 0, 0, 1])[1] < 1e-9
    return touching


@pytest.mark.parametrize(
    "kind",
    [
        np.round,  # a lattice
        lambda points: points[:, :2] @ [[1, 2, -1], [0, 1, 3]],  # a plane
        lambda points: points / np.linalg.norm(points, axis=1, keepdims=True),  # a sphere
        lambda points: points[:, :1] * [1, 2, 3] + 1e-6 * points,  # almost a line
    ],
)
def test_is_optimal_for_few_points(kind):
    rng = np.random.default_rng(2)
    for _ in range(25):
        points = kind(rng.normal(size=(rng.integers(2, 9), 3)))
        touching_points(points, *minimal_bounding_sphere(points))


def test_is_optimal_for_many_points_that_almost_all_matter():
    points = on_sphere(50_000) * (1 + 1e-8 * np.random.default_rng(5).random((50_000, 1)))
    assert 2 <= len(touching_points(points, *minimal_bounding_sphere(points))) <= 10

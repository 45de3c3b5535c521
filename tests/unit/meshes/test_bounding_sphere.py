"""The minimal enclosing sphere against analytic answers and independent solutions."""

from itertools import combinations, product

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


def smallest_by_brute_force(points):
    """Radius of the best circumsphere of one to four points (normal equations, no tolerance)."""
    best = np.inf
    for size in range(1, 5):
        for chosen in combinations(points, size):
            edges = np.array(chosen[1:]).reshape(-1, 3) - chosen[0]
            weights = np.linalg.pinv(edges @ edges.T) @ (edges**2).sum(axis=1) / 2
            centre = chosen[0] + weights @ edges
            best = min(best, np.linalg.norm(points - centre, axis=1).max())
    return best


@pytest.mark.parametrize(
    "kind",
    [
        np.round,  # a lattice
        lambda points: points[:, :2] @ [[1, 2, -1], [0, 1, 3]],  # a plane
        lambda points: points / np.linalg.norm(points, axis=1, keepdims=True),  # a sphere
        lambda points: points[:, :1] * [1, 2, 3] + 1e-6 * points,  # almost a line
    ],
)
def test_against_brute_force(kind):
    rng = np.random.default_rng(2)
    for _ in range(25):
        points = kind(rng.normal(size=(rng.integers(2, 9), 3)))
        centre, radius = minimal_bounding_sphere(points)
        assert np.linalg.norm(points - centre, axis=1).max() <= radius * (1 + 1e-12)
        assert radius == pytest.approx(smallest_by_brute_force(points), rel=1e-10)


def test_is_optimal_for_many_points_that_almost_all_matter():
    # A sphere is minimal exactly if its centre is a convex combination of points on it.
    points = on_sphere(50_000) * (1 + 1e-8 * np.random.default_rng(5).random((50_000, 1)))
    centre, radius = minimal_bounding_sphere(points)
    touching = points[np.linalg.norm(points - centre, axis=1) > radius * (1 - 1e-12)]
    assert 2 <= len(touching) <= 10
    system = np.vstack([(touching - centre).T, np.ones(len(touching))])
    assert nnls(system, [0, 0, 0, 1])[1] < 1e-9

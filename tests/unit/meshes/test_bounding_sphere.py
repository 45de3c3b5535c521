"""The minimal enclosing sphere against analytic answers and independent solutions."""

from itertools import combinations, product

import numpy as np
import pytest
from scipy.optimize import nnls

from neural_shadows.meshes.bounding_sphere import minimal_bounding_sphere

CUBE = np.array(list(product((-1.0, 1.0), repeat=3)))


def on_sphere(n, seed=0):
    points = np.random.default_rng(seed).normal(size=(n, 3))
    return points / np.linalg.norm(points, axis=1, keepdims=True)


def sphere(points):
    """The sphere, which encloses all points."""
    centre, radius = minimal_bounding_sphere(points)
    assert np.linalg.norm(points - centre, axis=1).max() <= radius * (1 + 1e-12)
    return centre, radius


@pytest.mark.parametrize(
    ("points", "centre", "radius"),
    [
        ([[3, -4, 5]] * 7, [3, -4, 5], 0),
        ([[0, 0, 0], [2, 4, 4]], [1, 2, 2], 3),
        (np.vstack([CUBE, 0.9 * on_sphere(100)]), [0, 0, 0], np.sqrt(3)),
        # obtuse: the longest side is a diameter
        ([[0, 0, 0], [10, 0, 0], [4, 1, 0]], [5, 0, 0], 5),
        # equilateral: the circumcircle, of radius side / sqrt(3)
        ([[0, 0, 0], [1, 0, 0], [0.5, np.sqrt(0.75), 0]], [0.5, np.sqrt(1 / 12), 0], 3**-0.5),
        # an acute triangle, whose circumcentre is neither its box's nor its centroid
        ([[-1, 0, 0], [1, 0, 0], [0, 2, 0], [0, 1, 0]], [0, 0.75, 0], 1.25),
        # collinear, in no order
        (np.outer([0.3, -1, 0, 1, 0.3, 0.99], [2, 3, 6]), [0, 0, 0], 7),
        # in a plane
        ([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0.1, 0, 0]], [0.5, 0.5, 0], 0.5**0.5),
    ],
)
def test_analytic(points, centre, radius):
    found_centre, found_radius = sphere(np.array(points, dtype=float))
    assert found_centre == pytest.approx(centre, abs=1e-14)
    assert found_radius == pytest.approx(radius, rel=1e-14)


@pytest.mark.parametrize("scale", [1e-3, 1e-200, 1e200], ids="{:g}".format)
def test_scales_with_the_unit(scale):
    points = np.random.default_rng(1).normal(size=(500, 3))
    centre, radius = minimal_bounding_sphere(points)
    scaled_centre, scaled_radius = minimal_bounding_sphere(points * scale)
    assert scaled_centre / scale == pytest.approx(centre, abs=1e-13)
    assert scaled_radius / scale == pytest.approx(radius, rel=1e-13)


def test_offset():
    centre, radius = sphere(on_sphere(20_000) * 0.01 + 1e6)
    # Coordinates at 1e6 are multiples of 1.2e-10.
    assert [*centre, radius] == pytest.approx([1e6, 1e6, 1e6, 0.01], abs=5e-10, rel=0)


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


KINDS = {
    "normal": lambda points: points,
    "lattice": np.round,
    "plane": lambda points: points[:, :2] @ [[1, 2, -1], [0, 1, 3]],
    "sphere": lambda points: points / np.linalg.norm(points, axis=1, keepdims=True),
    "almost a line": lambda points: points[:, :1] * [1, 2, 3] + 1e-6 * points,
}


@pytest.mark.parametrize("kind", KINDS)
def test_against_brute_force(kind):
    rng = np.random.default_rng(2)
    for _ in range(25):
        points = KINDS[kind](rng.normal(size=(rng.integers(2, 9), 3)))
        assert sphere(points)[1] == pytest.approx(smallest_by_brute_force(points), rel=1e-10)


@pytest.mark.parametrize(
    "points",
    [
        on_sphere(50_000) * [1, 2, 3] + 5,
        # almost on a sphere, so that almost every point matters
        on_sphere(50_000) * (1 + 1e-8 * np.random.default_rng(5).random((50_000, 1))),
    ],
)
def test_is_optimal_for_many_points(points):
    # A sphere is minimal exactly if its centre is a convex combination of points on it.
    centre, radius = minimal_bounding_sphere(points)
    touching = points[np.linalg.norm(points - centre, axis=1) > radius * (1 - 1e-12)]
    assert 2 <= len(touching) <= 10
    system = np.vstack([(touching - centre).T, np.ones(len(touching))])
    assert nnls(system, [0, 0, 0, 1])[1] < 1e-9

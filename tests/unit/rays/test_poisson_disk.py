import numpy as np
import pytest
from scipy.spatial import cKDTree
from scipy.stats import chisquare

from neural_shadows.rays.poisson_disk import exactly, poisson_disk, sphere_directions

TORUS = {False: {"boxsize": 1}, True: {}}  # by `on_sphere`


def closest_pair(points, on_sphere):
    return cKDTree(points, **TORUS[on_sphere]).query(points, k=2)[0][:, 1].min()


@pytest.mark.parametrize("on_sphere", [True, False])
@pytest.mark.parametrize("radius", [0.9, 0.3, 0.1, 0.03])
def test_no_pair_is_closer_than_r_and_no_gap_is_left(on_sphere, radius):
    """Bridson's method leaves some gaps, where 30 candidates missed them: small ones, and few."""
    points = poisson_disk(radius, np.random.default_rng(1), on_sphere)
    probes = np.random.default_rng(3).normal(size=(100_000, 3))
    probes /= np.linalg.norm(probes, axis=1, keepdims=True)
    if on_sphere:
        assert np.abs(np.linalg.norm(points, axis=1) - 1).max() < 1e-14
    else:
        assert points.min() >= 0 and points.max() < 1
        probes = np.random.default_rng(3).random((100_000, 2))
    if len(points) > 1:
        # Not by a wide margin either: with many points some pair is nearly at r.
        assert radius <= closest_pair(points, on_sphere) < 1.2 * radius
    distances = cKDTree(points, **TORUS[on_sphere]).query(probes)[0]
    assert distances.max() < 1.3 * radius
    assert np.mean(distances > radius) < 0.01


@pytest.mark.parametrize("on_sphere", [True, False])
@pytest.mark.parametrize("count", [1, 2, 3, 7, 60, 2000])
def test_counts_are_exact_and_distances_kept(count, on_sphere):
    points, r = exactly(count, np.random.default_rng(6), on_sphere)
    assert points.shape == (count, 3 if on_sphere else 2)
    if count > 1:
        assert closest_pair(points, on_sphere) >= r
        # r is the large one that belongs to the count: n r² / area is 0.615 of full sets.
        assert count * r**2 / (4 * np.pi if on_sphere else 1) > 0.5


def test_directions_cover_the_sphere_evenly():
    """One random direction of each of many sets, in 6 × 8 bins of equal area."""
    rng = np.random.default_rng(7)
    x, y, z = np.array([sphere_directions(12, seed)[0][rng.integers(12)] for seed in range(6000)]).T
    angle = np.arctan2(y, x)
    counts = np.histogram2d(z, angle, bins=(np.linspace(-1, 1, 7), np.linspace(-np.pi, np.pi, 9)))
    assert chisquare(counts[0].ravel()).pvalue > 1e-3

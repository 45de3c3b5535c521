from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from scipy.spatial import cKDTree
from scipy.stats import chisquare

from neural_shadows.rays.poisson_disk import (
    PatternBank,
    exactly,
    poisson_disk_sphere,
    poisson_disk_torus,
    sphere_directions,
)


def uniform_directions(count, rng):
    directions = rng.normal(size=(count, 3))
    return directions / np.linalg.norm(directions, axis=1, keepdims=True)


def torus_pattern(count, seed):
    return exactly(count, np.random.default_rng(seed), False)


def closest_pair(points, **torus):
    return cKDTree(points, **torus).query(points, k=2)[0][:, 1].min()


@pytest.mark.parametrize("radius", [1.2, 0.5, 0.1, 0.03])
def test_no_pair_on_the_sphere_is_closer_than_r(radius):
    points = poisson_disk_sphere(radius, np.random.default_rng(1))
    assert np.abs(np.linalg.norm(points, axis=1) - 1).max() < 1e-14
    # Not by a wide margin either: with this many points some pair is nearly at r.
    assert radius <= closest_pair(points) < 1.2 * radius


@pytest.mark.parametrize("radius", [0.3, 0.1, 0.02])
def test_no_pair_on_the_torus_is_closer_than_r(radius):
    points = poisson_disk_torus(radius, np.random.default_rng(1))
    assert points.min() >= 0 and points.max() < 1
    assert radius <= closest_pair(points, boxsize=1) < 1.2 * radius


def assert_maximal(distances, radius):
    """Distances from dense probes to the closest point.

    A hole that takes another point is farther than r from all. Bridson's method leaves some,
    where 30 candidates missed it: small ones, and few.
    """
    assert distances.max() < 1.3 * radius
    assert np.mean(distances > radius) < 0.005


def test_no_gap_is_left_on_the_sphere():
    points = poisson_disk_sphere(0.05, np.random.default_rng(2))  # about 3,100
    probes = uniform_directions(300_000, np.random.default_rng(3))
    assert_maximal(cKDTree(points).query(probes)[0], 0.05)


def test_no_gap_is_left_on_the_torus():
    points = poisson_disk_torus(0.02, np.random.default_rng(2))  # about 1,500
    probes = np.random.default_rng(3).random((300_000, 2))
    assert_maximal(cKDTree(points, boxsize=1).query(probes)[0], 0.02)


def radial_power(patterns, highest):
    """Mean power |Σ exp(−2πi f·x)|² / n of patterns by |f| = 1 ... highest; white noise has 1."""
    f = np.arange(-highest, highest + 1)
    total = 0.0
    for points in patterns:
        waves = np.exp(-2j * np.pi * points[:, :, None] * f)
        total += np.abs(np.einsum("na,nb->ab", waves[:, 0], waves[:, 1])) ** 2 / len(points)
    ring = np.rint(np.hypot(*np.meshgrid(f, f))).astype(int)
    return np.array(
        [total[ring == radius].mean() / len(patterns) for radius in range(1, highest + 1)]
    )


def test_torus_patterns_are_blue_noise_and_uniform_points_are_not():
    count = 250
    rng = np.random.default_rng(4)
    power = radial_power([torus_pattern(count, seed)[0] for seed in range(20)], 40)
    peak = power.argmax() + 1
    assert power[peak - 1] > 1.3
    assert power[: peak // 2].max() < 0.2
    white = radial_power([rng.random((count, 2)) for _ in range(20)], 40)
    assert white[: peak // 2].min() > 0.7


def test_sphere_directions_are_blue_noise():
    """Pair correlation: no pairs up to r, more than uniform just past it, as many far off."""
    directions, r = sphere_directions(3000, 5)
    chords = np.array([0.999, 1.2, 4.0, 5.0]) * r
    pairs = cKDTree(directions).count_neighbors(cKDTree(directions), chords) - 3000
    expected = 3000**2 * chords**2 / 4  # the cap within a chord c is c²/4 of the sphere
    assert pairs[0] == 0
    assert (pairs[1] - pairs[0]) / (expected[1] - expected[0]) > 1.2
    assert (pairs[3] - pairs[2]) / (expected[3] - expected[2]) == pytest.approx(1, abs=0.05)


@pytest.mark.parametrize("count", [1, 2, 3, 7, 60, 2000])
def test_counts_are_exact_and_distances_kept(count):
    directions, r = sphere_directions(count, 6)
    assert directions.shape == (count, 3)
    pattern, r_torus = torus_pattern(count, 6)
    assert pattern.shape == (count, 2)
    if count > 1:
        assert closest_pair(directions) >= r
        assert closest_pair(pattern, boxsize=1) >= r_torus
        # r is the large one that belongs to the count: n r² / area is 0.615 of full sets.
        assert count * r**2 / (4 * np.pi) > 0.5
        assert count * r_torus**2 > 0.5


def test_directions_cover_the_sphere_evenly():
    """One random direction of each of many sets, in 6 × 8 bins of equal area."""
    rng = np.random.default_rng(7)
    x, y, z = np.array([sphere_directions(12, seed)[0][rng.integers(12)] for seed in range(6000)]).T
    angle = np.arctan2(y, x)
    counts = np.histogram2d(z, angle, bins=(np.linspace(-1, 1, 7), np.linspace(-np.pi, np.pi, 9)))
    assert chisquare(counts[0].ravel()).pvalue > 1e-3
    # One set of many: evener than independent directions, whose bins scatter by √n.
    x, y, z = sphere_directions(4800, 8)[0].T
    counts = np.histogram2d(z, np.arctan2(y, x), bins=(6, 8))[0]
    assert np.abs(counts - 100).max() < 20


def patterns_of(table, n):
    start, patterns, points = table
    return points[start[n] : start[n] + n * patterns[n]].reshape(patterns[n], n, 2)


def test_bank_gives_the_same_in_any_order_and_from_threads():
    forward, backward, shared = PatternBank(1), PatternBank(1), PatternBank(1)
    forward.table(np.array([5]))
    backward.table(np.array([9, 0]))
    with ThreadPoolExecutor(4) as pool:
        list(pool.map(shared.table, np.arange(40).reshape(-1, 2) % 12))
    wanted = np.array([5, 9])
    for n in wanted:
        expected = patterns_of(forward.table(wanted), n)
        assert len(expected) >= 4 and not np.array_equal(expected[0], expected[1])
        assert np.array_equal(patterns_of(backward.table(wanted), n), expected)
        assert np.array_equal(patterns_of(shared.table(wanted), n), expected)
        assert not np.array_equal(patterns_of(PatternBank(2).table(wanted), n), expected)

import numpy as np
import pytest
from scipy.special import sph_harm_y

from neural_shadows.rays.poisson_disk import sphere_directions
from neural_shadows.reports.figures.view_directions import angular_power_spectrum, draw


def uniform(count, seed):
    x = np.random.default_rng(seed).normal(size=(count, 3))
    return x / np.linalg.norm(x, axis=1, keepdims=True)


def test_equals_the_sum_over_spherical_harmonics():
    x = uniform(40, 1)
    theta, phi = np.arccos(x[:, 2]), np.arctan2(x[:, 1], x[:, 0])
    for degree, power in enumerate(angular_power_spectrum(x, 6), start=1):
        sums = [sph_harm_y(degree, m, theta, phi).sum() for m in range(-degree, degree + 1)]
        expected = 4 * np.pi / (40 * (2 * degree + 1)) * np.sum(np.abs(sums) ** 2)
        assert power == pytest.approx(expected, rel=1e-9)


def test_independent_directions_are_white_and_poisson_disks_blue(tmp_path):
    # Each S_l is a chi-squared mean of 2l + 1 terms: over 30 degrees and 8 sets, 1 ± 0.02.
    mean = np.mean([angular_power_spectrum(uniform(300, seed), 30) for seed in range(8)])
    assert mean == pytest.approx(1, abs=0.1)
    power = angular_power_spectrum(sphere_directions(500, 1)[0], 50)
    assert power[:20].max() < 0.25
    assert power[-10:].mean() > 1
    draw(tmp_path / "f.png", tmp_path / "f.svg", title="Directions", seed=1)
    assert (tmp_path / "f.svg").stat().st_size < 600_000

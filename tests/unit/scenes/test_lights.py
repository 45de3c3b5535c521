import numpy as np
from scipy.stats import kstest

from neural_shadows.scenes.lights import axis_vector, draw_light, light_basis


def draws(domain, up):
    rng = np.random.default_rng(3)
    lights = np.array([draw_light(domain, up, rng) for _ in range(4000)])
    np.testing.assert_allclose(np.linalg.norm(lights, axis=1), 1, atol=1e-12)
    return lights


def test_sphere_lights_are_uniform_over_the_cap():
    up = np.array([0.6, 0.0, 0.8])
    lights = draws({"domain": "sphere", "min_elevation_deg": 20}, up)
    height = lights @ up
    lowest = np.sin(np.radians(20))
    # By Archimedes, heights and azimuths of uniform points are uniform.
    assert kstest((height - lowest) / (1 - lowest), "uniform").pvalue > 1e-3
    turn = np.arctan2(*(light_basis(up)[:2] @ lights.T)) / (2 * np.pi)
    assert kstest(turn + 0.5, "uniform").pvalue > 1e-3


def test_single_axis_lights_are_uniform_along_the_arc():
    up, around = axis_vector("z"), axis_vector("x")
    lights = draws({"domain": "single_axis", "axis": "x", "min_elevation_deg": 15}, up)
    np.testing.assert_allclose(lights @ around, 0, atol=1e-12)
    angle = np.degrees(np.arctan2(lights @ np.cross(around, up), lights @ up))
    assert kstest((angle + 75) / 150, "uniform").pvalue > 1e-3


def test_light_basis_is_the_stated_one():
    np.testing.assert_allclose(light_basis(np.array([0.6, 0.8, 0.0]))[0], [-0.8, 0.6, 0.0])
    u, v, light = light_basis(np.array([2.0, -3.0, 6.0]) / 7)
    np.testing.assert_allclose(np.cross(u, v), light, atol=1e-12)

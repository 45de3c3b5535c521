"""Buffers of a frame beside what geometry says, and of what moves as a whole."""

import numpy as np
import pytest
from plate_frames import CENTRE, HEIGHT, WIDTH, camera, plate

from neural_shadows.frames.buffers import CHANNELS, buffers_of
from neural_shadows.rendering.surface import see_surface
from neural_shadows.shadow_maps.light_map import cube_map, perspective_map


def by_name(scene, view, centre, resolution=256):
    surface = see_surface(scene, view, WIDTH, HEIGHT)
    found = buffers_of(scene, surface, cube_map(centre, resolution)).astype(np.float64)
    return dict(zip(CHANNELS, found)), surface


@pytest.fixture(scope="module")
def plated():
    return by_name(plate(), camera(), CENTRE)


def test_distances_and_cosines_of_a_ground(plated):
    """The camera sees the ground alone: it lies at y = 0, its normal points up."""
    found, surface = plated
    size, p = plate().size, surface.image(surface.p).astype(np.float64)
    from_light = np.linalg.norm(p - CENTRE, axis=-1)
    assert np.allclose(found["z"] * size, from_light, rtol=1e-3)
    assert np.allclose(found["d"] * size, np.linalg.norm(p - camera().eye, axis=-1), rtol=1e-3)
    assert np.allclose(found["c_e"], CENTRE[1] / from_light, atol=1e-3)
    assert np.allclose([found[f"n_{axis}"] for axis in "xyz"], np.eye(3)[1][:, None, None])


def test_what_a_ball_hides(plated):
    """In its shadow the map shows the ball's upper side, 1.2 m to 1 m over the ground."""
    found, _ = plated
    dark = found["hard"] == 0
    assert 0.1 < dark.mean() < 0.9
    gap = found["gap"] * plate().size
    assert np.all((gap[dark] < -0.9) & (gap[dark] > -1.3))
    lit = ~dark
    assert np.abs(gap[lit]).max() < 0.03 and np.all(found["agreement"][lit] > 0.999)
    # The ball's upper side, as the light sees it; elsewhere the ground that the camera sees.
    seen, own = (np.stack([found[f"{name}_{axis}"] for axis in "xyz"]) for name in "en")
    assert np.all(seen[1, dark] > 0) and np.mean(np.abs(seen - own).max(0)[dark] > 0.01) > 0.9
    assert np.allclose(seen[:, lit], own[:, lit], atol=1e-3)
    assert np.allclose((seen * own).sum(0), found["agreement"], atol=2e-3)
    inside = (found["msm"] < 0.05) & (found["pcf"] < 0.05)
    assert (dark & inside).mean() > 0.8 * dark.mean()
    # Moments of 3 × 3 texels see the ball a texel farther out than 2 × 2 tests do.
    assert np.mean(found["msm"][lit & (found["pcf"] == 1)] > 0.9) > 0.97


def test_where_the_map_shows_nothing():
    """A picture that looks up: the point's own normal, and all lit."""
    surface = see_surface(plate(), camera(), WIDTH, HEIGHT)
    away = perspective_map(CENTRE, np.array([0.0, 1.0, 0.0]), 60, 16)
    found = dict(zip(CHANNELS, buffers_of(plate(), surface, away)))
    assert all(np.array_equal(found[f"e_{axis}"], found[f"n_{axis}"]) for axis in "xyz")
    assert not found["gap"].any() and np.all(found["agreement"] == 1)

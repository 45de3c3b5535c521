"""Our rays, and Mitsuba's render, beside the exact shadow of a ball under a spherical light."""

import numpy as np
import sphere_light as exact
import trimesh
from shapes import scene_of

from neural_shadows.rendering.light_samples import random_shifts, ring_vectors, sequence_run

SAMPLES = 4096


def differences(found: np.ndarray, expected: np.ndarray) -> tuple[str, float, float, float]:
    """In the penumbra: a line, mean, rms and largest."""
    some = (expected > 0.001) & (expected < 0.999)
    assert some.sum() > 20
    off = (found - expected)[some]
    mean, rms, most = off.mean(), np.sqrt(np.mean(off**2)), np.abs(off).max()
    return f"mean {mean:+.5f}, rms {rms:.5f}, largest {most:.5f} of {some.sum()}", mean, rms, most


def test_our_rays(measured):
    ball = trimesh.creation.icosphere(subdivisions=6, radius=exact.BALL_RADIUS)
    scene = scene_of(ball.apply_translation(exact.BALL), ground=False)
    points = np.zeros((exact.POINTS, 3), np.float32)
    points[:, 0] = exact.X
    ways = np.empty((exact.POINTS, SAMPLES, 3), np.float32)
    light = exact.LIGHT, np.array([exact.LIGHT_RADIUS]), np.array([SAMPLES])
    ring_vectors(
        points, random_shifts(np.arange(exact.POINTS), 1), sequence_run(0, SAMPLES), *light, ways
    )
    free = ~scene.tracer.blocked(np.repeat(points, SAMPLES, axis=0), ways.reshape(-1, 3))
    found = free.reshape(exact.POINTS, SAMPLES).mean(1)
    expected = np.array([exact.seen_of_disc(x) for x in exact.X])
    line, mean, rms, most = differences(found, expected)
    measured(f"ball under a sphere, {SAMPLES} of our rays a point: {line}")
    assert abs(mean) < 5e-4 and rms < 2e-3 and most < 5e-3


def test_mitsuba(run_outside, measured):
    """Shows that the exact shadow is right; noise of 4,096 samples is 0.008 at the most."""
    around = {
        name.lower(): getattr(exact, name)
        for name in ("LIGHT", "LIGHT_RADIUS", "BALL", "BALL_RADIUS", "POINTS", "WIDTH")
    }
    found = run_outside("mitsuba_sphere.py", samples=SAMPLES, **around)["visibility"]
    # A pixel is a cell: the mean over four places in it.
    shifts = (np.arange(4) - 1.5) / 4 * exact.WIDTH / exact.POINTS
    expected = [np.mean([exact.seen_of_sphere(x + s, 10_000) for s in shifts]) for x in exact.X]
    line, mean, rms, most = differences(found, np.array(expected))
    measured(f"ball under a sphere, rendered by Mitsuba with {SAMPLES} samples: {line}")
    assert abs(mean) < 3e-3 and rms < 8e-3 and most < 0.035

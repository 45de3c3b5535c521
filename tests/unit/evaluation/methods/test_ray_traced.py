"""Few rays a pixel beside the exact soft shadow."""

from dataclasses import replace

import numpy as np
import pytest
from plate_frames import CENTRE, HEIGHT, RADIUS, WIDTH, error, plate, plate_frame, plate_truth

from neural_shadows.frames import ray_tracing
from neural_shadows.frames.ray_tracing import ray_traced
from neural_shadows.rendering.light_shape import SPHERE, light_shape

PANEL = light_shape({"shape": "rectangle", "aspect": 0.5})
SHAPES = pytest.mark.parametrize("shape", [SPHERE, PANEL], ids=lambda shape: shape.shape)


@pytest.fixture(scope="module")
def frame():
    return plate_frame()


@SHAPES
def test_one_ray_is_right_on_average(shape):
    frame, truth = plate_frame(shape=shape), plate_truth.__wrapped__(shape=shape)
    assert len(frame.starts) == WIDTH * HEIGHT
    found = ray_traced(frame, RADIUS, samples=1)
    assert found.dtype == np.float32 and {*np.unique(found)} == {0, 1}
    noise = np.sqrt(np.sum(truth * (1 - truth))) / len(truth)
    assert 0.001 < noise < 0.01
    assert abs(np.mean(found - truth)) < 3 * noise
    # The errors of neighbours have nothing to do with each other.
    off = (found - truth).reshape(HEIGHT, WIDTH)
    for a, b in ((off[1:], off[:-1]), (off[:, 1:], off[:, :-1])):
        assert abs(np.mean(a * b)) < 0.05 * np.mean(off * off)


@SHAPES
def test_errors_fall_at_least_as_fast_as_of_independent_rays(shape):
    frame, truth = plate_frame(shape=shape), plate_truth.__wrapped__(shape=shape)
    one = np.mean(truth * (1 - truth))
    assert error(ray_traced(frame, RADIUS, samples=1), truth) == pytest.approx(one, rel=0.1)
    for samples in (4, 16, 64):
        assert error(ray_traced(frame, RADIUS, samples=samples), truth) < one / samples


def test_a_point_gets_one_ray(frame):
    ways = (CENTRE - frame.starts).astype(np.float32)
    hard = ~plate().tracer.blocked(frame.starts, ways)
    assert 0.02 < 1 - hard.mean() < 0.5
    assert np.array_equal(ray_traced(frame, 0, samples=16), hard.astype(np.float32))


def test_rays_in_parts_and_of_later_frames(frame, monkeypatch):
    eight = ray_traced(frame, RADIUS, samples=8)
    monkeypatch.setattr(ray_tracing, "_CHUNK", 1000)
    assert np.array_equal(ray_traced(frame, RADIUS, samples=8), eight)
    many = ray_traced(frame, RADIUS, samples=64)
    for count in (2, 4, 8):
        later = [ray_traced(replace(frame, number=k), RADIUS, samples=count) for k in range(4)]
        squares = [np.mean(np.square(one - many)) for one in (*later, np.mean(later, axis=0))]
        assert squares[-1] < 0.4 * np.mean(squares[:-1])  # the same rays would leave all

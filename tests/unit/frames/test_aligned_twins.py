"""Pixels of a wall and of the same wall from a camera that has moved along it."""

import numpy as np
import pytest

from neural_shadows.frames.aligned_twins import twin_pixels
from neural_shadows.rendering.gbuffer import axis_cosines
from neural_shadows.scenes.arrangement import UP
from neural_shadows.scenes.cameras import Camera, Window

WIDTH, HEIGHT, SIZE = 40, 24, 4.0


def wall(camera):
    """Buffers of the plane z = 0, seen head-on from a distance of 1 m."""
    d = 1 / axis_cosines(camera, WIDTH, HEIGHT) / SIZE
    zero = np.zeros_like(d)
    return {"d": d.astype(np.float16), "n_x": zero, "n_y": zero.copy(), "n_z": zero + 1}


def pair(window=None, right=3.0, up=-2.0):
    """A camera, and one that has moved by so many pixels' width at the wall."""
    first = Camera(np.array([0.0, 0.0, 1.0]), np.zeros(3), UP, 55.0, window)
    step = np.array([right, up, 0.0]) / first.focal(HEIGHT)
    return first, Camera(first.eye + step, first.target + step, UP, 55.0, window)


@pytest.mark.parametrize("window", [None, Window(256, 128, 30, 5)])
def test_a_shifted_camera_sees_a_plane_shifted(window):
    first, second = pair(window)
    counts, rows, columns = twin_pixels(first, wall(first), second, wall(second), SIZE)
    row, column = np.mgrid[:HEIGHT, :WIDTH]
    assert np.array_equal(counts, (column >= 3) & (row >= 2))  # what the other does not see is out
    assert np.array_equal(columns[counts], (column - 3)[counts])
    assert np.array_equal(rows[counts], (row - 2)[counts])


def test_the_nearest_pixel_is_taken():
    first, second = pair(right=0.4, up=0.4)
    counts, rows, columns = twin_pixels(first, wall(first), second, wall(second), SIZE)
    row, column = np.mgrid[:HEIGHT, :WIDTH]
    assert counts.all() and np.array_equal(rows, row) and np.array_equal(columns, column)


def test_other_surfaces_do_not_count():
    """What is 0.07 of the scene's size farther, or turned by 24 degrees: its distance is 0.4."""
    first, second = pair()
    there = wall(second)
    there["d"][:, :10] += 0.08
    there["d"][:, 10:15] += 0.06
    there["n_x"][:, 20:25], there["n_z"][:, 20:25] = np.sin(0.42), np.cos(0.42)
    there["n_x"][:, 30:], there["n_z"][:, 30:] = np.sin(0.38), np.cos(0.38)
    counts, _, columns = twin_pixels(first, wall(first), second, there, SIZE)
    seen = np.arange(WIDTH) - 3  # the twin's column
    assert np.array_equal(counts[5], (seen >= 10) & ((seen < 20) | (seen >= 25)))

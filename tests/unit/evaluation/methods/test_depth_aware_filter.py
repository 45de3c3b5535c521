"""A filter in the picture that edges of depth stop."""

import numpy as np
import pytest

from neural_shadows.evaluation.method_parts.depth_aware_filter import depth_aware
from neural_shadows.rendering.surface import Surface
from neural_shadows.scenes.cameras import Camera

WIDTH, HEIGHT = 16, 12


def wall(distance, normals=None):
    """Pixels whose points lie at distances (height, width) from the eye; none where infinite.

    Of normals (height, width, 3), or of one.
    """
    camera = Camera(np.array([1.0, 2, 3]), np.zeros(3), np.array([0, 1.0, 0]), 50.0)
    pixel = np.flatnonzero(np.isfinite(distance))
    way = np.array([0.6, 0, -0.8])
    p = (camera.eye + distance.ravel()[pixel, None] * way).astype(np.float32)
    n = np.zeros((HEIGHT, WIDTH, 3), np.float32)
    n[:] = [0, 0.6, 0.8] if normals is None else normals
    n = n.reshape(-1, 3)[pixel]
    return Surface(camera, WIDTH, HEIGHT, pixel, pixel, p, n, n)


def test_a_gaussian_where_depth_is_the_same():
    surface = wall(np.full((HEIGHT, WIDTH), 5.0))
    spike = np.zeros((HEIGHT, WIDTH), np.float32)
    spike[6, 8] = 1
    found = depth_aware(surface, spike.ravel(), 1.5).reshape(HEIGHT, WIDTH)
    line = np.exp(-0.5 * (np.arange(-2, 3) / 1.5) ** 2)
    kernel = np.outer(line, line) / line.sum() ** 2
    assert np.allclose(found[4:9, 6:11], kernel, atol=1e-4)
    assert found.sum() == pytest.approx(1, abs=1e-4)


def test_an_edge_of_depth_stops_it():
    distance = np.full((HEIGHT, WIDTH), 5.0)
    distance[:, 8:] = 5.3  # 6 %
    distance[:2] = np.inf
    surface = wall(distance)
    visibility = (surface.pixel % WIDTH < 8).astype(np.float32)
    assert np.allclose(depth_aware(surface, visibility, 1.5), visibility, atol=1e-6)
    # A hundredth is one deviation: that goes through.
    distance[2:, 8:] = 5.05
    mixed = surface.pixel % WIDTH == 8
    assert depth_aware(wall(distance), visibility, 1.5)[mixed].min() > 0.2
    # A third of the width: a neighbour weighs e^−2.
    assert 0.05 < depth_aware(wall(distance), visibility, 0.5)[mixed].min() < 0.1


def test_an_edge_of_normals_stops_it():
    normals = np.zeros((HEIGHT, WIDTH, 3), np.float32)
    normals[:, :8, 2], normals[:, 8:, 1] = 1, 1
    surface = wall(np.full((HEIGHT, WIDTH), 5.0), normals)
    visibility = (surface.pixel % WIDTH < 8).astype(np.float32)
    assert np.allclose(depth_aware(surface, visibility, 1.5), visibility, atol=1e-6)

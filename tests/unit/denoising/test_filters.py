"""What every filter does to pictures whose smooth form is known."""

import os
import subprocess
import sys

import numpy as np
import pytest
from filtered_walls import COLUMNS, FILTERS, HEIGHT, PIXEL, RIGHT, WIDTH, denoise, two_walls, wall

# SIGMA keeps planes apart, not normals.
KEPT_APART = [("svgf", "depth"), ("svgf", "normal"), ("ffx", "depth"), ("ffx", "normal")]
KEPT_APART += [("sigma", "depth")]


@pytest.mark.parametrize("key, edge", KEPT_APART)
def test_nothing_crosses_an_edge(key, edge):
    noise = np.random.default_rng(1).random((HEIGHT, WIDTH)) * 0.6
    noise[RIGHT] += 0.4
    found = denoise(key, noise, *two_walls(edge))
    assert found[~RIGHT].max() < 0.6 and found[RIGHT].min() > 0.4
    for side, mean in ((~RIGHT, 0.3), (RIGHT, 0.7)):
        assert np.abs(found - mean)[side].mean() < 0.05
    # On a surface without the edge it does.
    blurred = denoise(key, noise, *wall())
    assert blurred[:, 29].mean() > found[:, 29].mean() + 0.05


_TINY = """
import numpy as np
from filtered_walls import FILTERS
for height, width in np.ndindex(3, 4):
    size = height + 1, width + 1
    dark, depth = np.random.default_rng(width).random((2, *size), np.float32)
    place = np.stack([depth, depth, depth], axis=-1)
    for denoise in FILTERS.values():
        denoise(dark, depth, place)
"""


def test_tiny_pictures():
    """Nothing is read beyond pictures of few pixels; numpy, unlike Numba, checks."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path), "NUMBA_DISABLE_JIT": "1"}
    subprocess.run([sys.executable, "-c", _TINY], check=True, env=environment)


def test_sigma_blurs_what_is_near_the_plane_behind_a_crease():
    """A wall that recedes at 45° is off the other's plane after 2.8 pixels; taps reach 8.4, twice."""
    depth, normal = wall()
    depth = depth + np.float32(PIXEL) * np.maximum(COLUMNS - 29.5, 0).astype(np.float32)
    normal = np.where(RIGHT[..., None], np.float32([-(0.5**0.5), 0, 0.5**0.5]), normal)
    step = np.where(RIGHT, 0.8, 0.3)
    off = np.abs(denoise("sigma", step, depth, normal) - step)
    far = np.abs(COLUMNS - 29.5) > 17
    assert off[far].max() < 1e-6 and 0.05 < off[~far].max() < 0.25


@pytest.mark.parametrize("key", FILTERS)
def test_pixels_without_a_surface_stay_and_count_nowhere(key):
    noise = np.random.default_rng(2).random((HEIGHT, WIDTH)) * 0.6
    depth, normal = wall()
    depth, normal = np.where(RIGHT, 0, depth), np.where(RIGHT[..., None], 0, normal)
    found = denoise(key, np.where(RIGHT, 1, noise), depth, normal)
    assert found[RIGHT].min() > 1 - 1e-6
    assert found[~RIGHT].max() < 0.6 and np.abs(found - 0.3)[~RIGHT].mean() < 0.05


# At least how many times less the squared error is, of 1 and of 4 rays a pixel.
FALLS = {("svgf", 1): 10, ("svgf", 4): 8, ("ffx", 1): 12, ("ffx", 4): 8, ("sigma", 1): 10}
FALLS |= {("sigma", 4): 6}


@pytest.mark.parametrize("key, samples", FALLS)
def test_a_noisy_penumbra(key, samples):
    truth = np.clip((COLUMNS - 10) / 36, 0, 1)
    falls, biases = [], []
    for seed in range(4):
        noisy = (np.random.default_rng(seed).random((samples, HEIGHT, WIDTH)) < truth).mean(0)
        found = denoise(key, noisy, *wall())
        assert found.dtype == np.float32 and found.min() >= 0 and found.max() <= 1
        falls.append(np.mean((noisy - truth) ** 2) / np.mean((found - truth) ** 2))
        biases.append(np.mean(found - noisy))
    assert min(falls) > FALLS[key, samples]
    assert abs(np.mean(biases)) < 0.005 and np.abs(biases).max() < 0.01

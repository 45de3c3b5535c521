"""The SVGF-like filter beside its formulas, and on pictures whose result is known."""

from itertools import product

import numpy as np
import pytest
from scipy.ndimage import convolve, uniform_filter

from neural_shadows.denoising.svgf import SvgfFilter, svgf_like

HEIGHT, WIDTH = 40, 56
COLUMNS = np.broadcast_to(np.arange(WIDTH), (HEIGHT, WIDTH))
RIGHT = COLUMNS >= 30


def wall(depth=2.0, normal=(0, 0, 1)):
    """Guides of a surface across the view."""
    normals = np.empty((HEIGHT, WIDTH, 3), np.float32)
    normals[:] = normal
    return np.full((HEIGHT, WIDTH), depth, np.float32), normals


def two_walls(edge):
    """Guides that have one edge: where RIGHT begins."""
    (depth, normal), (depth_, normal_) = (
        wall(),
        wall(*{"depth": (3.0,), "normal": (2, (1, 0, 0))}[edge]),
    )
    return np.where(RIGHT, depth_, depth), np.where(RIGHT[..., None], normal_, normal)


def denoise(visibility, depth, normal):
    return svgf_like(SvgfFilter(*depth.shape), np.float32(visibility), depth, normal)


def test_what_has_no_noise_stays():
    constant = np.full((HEIGHT, WIDTH), 0.3)
    assert np.abs(denoise(constant, *wall()) - constant).max() < 1e-6
    for edge in ("depth", "normal"):
        step = np.where(RIGHT, 0.8, 0.3)
        assert np.abs(denoise(step, *two_walls(edge)) - step).max() < 1e-6


@pytest.mark.parametrize("edge", ["depth", "normal"])
def test_nothing_crosses_an_edge(edge):
    noise = np.random.default_rng(1).random((HEIGHT, WIDTH)) * 0.6
    noise[RIGHT] += 0.4
    found = denoise(noise, *two_walls(edge))
    assert found[~RIGHT].max() < 0.6 and found[RIGHT].min() > 0.4
    for side, mean in ((~RIGHT, 0.3), (RIGHT, 0.7)):
        assert np.abs(found - mean)[side].mean() < 0.05
    # On a surface without the edge it does.
    blurred = denoise(noise, *wall())
    assert blurred[:, 29].mean() > found[:, 29].mean() + 0.05


def test_pixels_without_a_surface_stay_and_count_nowhere():
    noise = np.random.default_rng(2).random((HEIGHT, WIDTH))
    depth, normal = wall()
    depth, normal = np.where(RIGHT, 0, depth), np.where(RIGHT[..., None], 0, normal)
    a, b = denoise(np.where(RIGHT, 1, noise), depth, normal), denoise(noise, depth, normal)
    assert np.abs(a[RIGHT] - 1).max() < 1e-6 and np.abs(a - b)[~RIGHT].max() < 1e-4


@pytest.mark.parametrize("samples, factor", [(1, 10), (4, 8)])
def test_a_noisy_penumbra(samples, factor):
    truth = np.clip((COLUMNS - 10) / 36, 0, 1)
    seen = np.random.default_rng(3).random((samples, HEIGHT, WIDTH)) < truth
    noisy = seen.mean(0)
    found = denoise(noisy, *wall())
    assert found.dtype == np.float32 and found.min() >= 0 and found.max() <= 1
    assert factor * np.mean((found - truth) ** 2) < np.mean((noisy - truth) ** 2)
    assert abs(np.mean(found - noisy)) < 0.01


def test_variance_on_a_wall_is_that_of_49_pixels():
    value = np.random.default_rng(4).random((HEIGHT, WIDTH)).astype(np.float32)
    svgf = SvgfFilter(HEIGHT, WIDTH)
    svgf.see(*wall())
    found = svgf.variance(value, value * value)
    expected = (
        uniform_filter(value.astype(float) ** 2, 7) - uniform_filter(value.astype(float), 7) ** 2
    )
    assert np.abs(found - expected)[3:-3, 3:-3].max() < 1e-5


def papers_passes(light, variance, depth, normal, slope):
    """The picture after each pass, as the paper writes it (Schied et al. 2017, 4.3, 4.4)."""
    rows, columns = np.mgrid[:HEIGHT, :WIDTH]
    kernel = [1 / 16, 1 / 4, 3 / 8, 1 / 4, 1 / 16]
    for step in (1, 2, 4, 8, 16):
        deviation = np.sqrt(convolve(variance, np.outer([1, 2, 1], [1, 2, 1]) / 16, mode="nearest"))
        total, mean, spread = np.zeros((3, HEIGHT, WIDTH))
        for down, along in product(range(-2, 3), repeat=2):
            v, u = rows + down * step, columns + along * step
            inside = (v >= 0) & (v < HEIGHT) & (u >= 0) & (u < WIDTH)
            there = np.clip(v, 0, HEIGHT - 1), np.clip(u, 0, WIDTH - 1)
            far = step * abs(slope[0] * along + slope[1] * down)
            weight = kernel[down + 2] * kernel[along + 2] * inside
            weight *= np.exp(-np.abs(depth - depth[there]) / (far + 1e-4 * depth))
            weight *= np.maximum(0, np.sum(normal * normal[there], axis=2)) ** 128
            weight *= np.exp(-np.abs(light - light[there]) / (4 * deviation + 1e-6))
            total += weight
            mean += weight * light[there]
            spread += weight**2 * variance[there]
        light, variance = mean / total, spread / total**2
        yield light


def test_the_passes_are_the_papers():
    rng = np.random.default_rng(5)
    slope = (0.02, -0.05)
    depth = np.float32(5 + slope[0] * COLUMNS + slope[1] * np.arange(HEIGHT)[:, None])
    normal = rng.normal([0, 0, 1], 0.08, (HEIGHT, WIDTH, 3)).astype(np.float32)
    normal /= np.linalg.norm(normal, axis=2, keepdims=True)
    light, variance = rng.random((2, HEIGHT, WIDTH)).astype(np.float32) * [[[1]], [[0.1]]]
    svgf = SvgfFilter(HEIGHT, WIDTH)
    svgf.see(depth, normal)
    first, *_, last = papers_passes(light, variance, depth.astype(float), normal, slope)
    found = svgf.smooth(light, variance)
    assert np.abs(first - light).mean() > 0.05 and np.abs(last - first).mean() > 0.01
    assert np.abs(found[0] - first).max() < 3e-3 and np.abs(found[1] - last).max() < 3e-3

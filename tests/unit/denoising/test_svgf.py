"""The SVGF-like filter beside its formulas."""

from itertools import product

import numpy as np
from filtered_walls import COLUMNS, HEIGHT, WIDTH, wall
from scipy.ndimage import convolve, uniform_filter

from neural_shadows.denoising.svgf import PASSES, SvgfFilter
from neural_shadows.denoising.trials import smooth
from neural_shadows.denoising.wavelet import SIGMA_DEPTH


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
    """The picture after each pass, as the paper writes it, with our σ_z (Schied et al. 2017, 4.3, 4.4)."""
    rows, columns = np.mgrid[:HEIGHT, :WIDTH]
    kernel = [1 / 16, 1 / 4, 3 / 8, 1 / 4, 1 / 16]
    for step in (1, 2, 4, 8, 16):
        deviation = np.sqrt(convolve(variance, np.outer([1, 2, 1], [1, 2, 1]) / 16, mode="nearest"))
        total, mean, spread = np.zeros((3, HEIGHT, WIDTH))
        for down, along in product(range(-2, 3), repeat=2):
            v, u = rows + down * step, columns + along * step
            inside = (v >= 0) & (v < HEIGHT) & (u >= 0) & (u < WIDTH)
            there = np.clip(v, 0, HEIGHT - 1), np.clip(u, 0, WIDTH - 1)
            far = SIGMA_DEPTH * step * abs(slope[0] * along + slope[1] * down)
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
    found = smooth(svgf, light, variance, PASSES)
    assert np.abs(first - light).mean() > 0.05 and np.abs(last - first).mean() > 0.01
    assert np.abs(found[0] - first).max() < 3e-3 and np.abs(found[1] - last).max() < 3e-3


def test_a_pass_is_the_first_of_all_and_none_leaves_the_picture():
    depth, normal = wall()
    noise = np.random.default_rng(0).random(depth.shape).astype(np.float32)
    outcomes = []
    for passes in (0, 1, 5):
        svgf = SvgfFilter(*depth.shape)
        svgf.see(depth, normal)
        outcomes.append(smooth(svgf, noise, svgf.noise(noise), passes))
    (_, none), (_, one), (first, five) = outcomes
    assert np.array_equal(none, noise) and np.array_equal(one, first)
    assert five.var() < one.var() / 4 < noise.var() / 16

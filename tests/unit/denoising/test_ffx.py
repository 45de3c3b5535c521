"""The FFX-like filter beside its formulas."""

from itertools import product

import numpy as np
import pytest
from filtered_walls import COLUMNS, HEIGHT, WIDTH, ffx, wall
from plate_frames import HEIGHT as ROWS
from plate_frames import WIDTH as COLS
from plate_frames import plate_frame
from scipy.ndimage import convolve, convolve1d

from neural_shadows.denoising.ffx import FfxFilter, FfxTrials, TemporalFfx
from neural_shadows.denoising.mixed_blocks import SIDE, Neighbourhoods
from neural_shadows.denoising.trials import smooth
from neural_shadows.rendering.reprojection import Reprojection


def neighbourhood(picture):
    """Mean of 17 × 17 pixels by e^(−3 i² / 81), as it is written."""
    kernel = np.exp(-3 * np.arange(-8, 9) ** 2 / 81)
    for axis in (0, 1):
        picture = convolve1d(picture, kernel / kernel.sum(), axis=axis, mode="nearest")
    return picture


def written_passes(light, variance, depth, normal, sigma):
    """The picture after each pass, of all pixels alike."""
    rows, columns = np.mgrid[:HEIGHT, :WIDTH]
    for step in (1, 2, 4):
        smooth = convolve(variance, np.outer([1, 2, 1], [1, 2, 1]) / 16, mode="nearest")
        total, mean, spread = np.ones(light.shape), light.copy(), variance.copy()
        for down, along in product((-1, 0, 1), repeat=2):
            v, u = rows + down * step, columns + along * step
            inside = (v >= 0) & (v < HEIGHT) & (u >= 0) & (u < WIDTH) & bool(down or along)
            there = np.clip(v, 0, HEIGHT - 1), np.clip(u, 0, WIDTH - 1)
            weight = (2 / 3) ** (abs(down) + abs(along)) * inside
            weight = weight * np.exp(-np.abs(light - light[there]) / sigma / np.sqrt(smooth + 1e-9))
            weight *= np.exp(-np.abs(depth - depth[there]) / (0.02 * depth))
            weight *= np.maximum(0, np.sum(normal * normal[there], axis=2)) ** 32
            total += weight
            mean += weight * light[there]
            spread += weight**2 * variance[there]
        light, variance = mean / total, spread / total**2
        yield light


@pytest.mark.parametrize("sigma", [1, 4])
def test_the_passes_are_as_written(sigma):
    """A lit, a mixed and a dark part: what is left as it is, is what the passes would make of it."""
    rng = np.random.default_rng(5)
    depth = np.float32(2 + 0.004 * COLUMNS - 0.002 * np.arange(HEIGHT)[:, None])
    normal = rng.normal([0, 0, 1], 0.08, (HEIGHT, WIDTH, 3)).astype(np.float32)
    normal /= np.linalg.norm(normal, axis=2, keepdims=True)
    rays = rng.random((HEIGHT, WIDTH)) < np.clip((COLUMNS - 24) / 8, 0, 1)
    light = rays.astype(np.float32)
    mean = neighbourhood(light.astype(float))
    filter_ = FfxFilter(HEIGHT, WIDTH, sigma)
    filter_.see(depth, normal)
    found_mean, noise = filter_.neighbourhood(light)
    assert np.abs(found_mean - mean).max() < 1e-5
    assert np.abs(noise - np.maximum(mean - mean**2, 0)).max() < 1e-5
    first, *_, last = written_passes(light.astype(float), 3 * noise, depth, normal, sigma)
    found = smooth(filter_, light, 3 * noise, 3)
    assert np.abs(first - light).mean() > 0.01 and np.abs(last - first).mean() > 0.003
    assert np.abs(found[0] - first).max() < 1e-3 and np.abs(found[1] - last).max() < 1e-3


def test_blocks_are_mixed_where_a_neighbourhood_is():
    picture = np.ones((64, 4 * SIDE), np.float32)
    picture[30, 2 * SIDE + 10] = 0.75  # one ray of four
    nearby = Neighbourhoods(*picture.shape)
    nearby.see(picture)
    rows, blocks = np.nonzero(nearby.mixed)
    assert set(rows) == set(range(22, 39)) and set(blocks) == {2}
    picture[30, 2 * SIDE + 10], picture[30, 2 * SIDE] = 1, 0.75
    nearby.see(picture)
    assert set(np.nonzero(nearby.mixed)[1]) == {1, 2}


def constant(value):
    return np.full((ROWS, COLS), value, np.float32)


def test_noise_over_time_and_a_sudden_change():
    """A lasting picture is kept; one that is another all around is taken at once."""
    surface, temporal = plate_frame().surface, TemporalFfx(ROWS, COLS)
    rays = np.random.default_rng(0).random((12, ROWS, COLS)) < 0.5
    back = Reprojection(surface, surface)
    pictures = [temporal.next_frame(one.astype(np.float32), surface, back) for one in rays]
    alone = FfxTrials(ROWS, COLS).single(rays[-1].astype(np.float32), surface)
    assert np.std(pictures[-1]) < np.std(alone) / 1.5
    assert abs(pictures[-1].mean() - rays.mean()) < 0.02
    assert np.array_equal(temporal.next_frame(constant(1), surface, back), constant(1))


def test_a_history_begins_anew_where_all_around_is_lit():
    """As tiles that the original clears: what was dark there before is not remembered."""
    surface = plate_frame().surface
    back = Reprojection(surface, surface)
    noise = (np.random.default_rng(2).random((ROWS, COLS)) < 0.5).astype(np.float32)
    forgetful, begun = (TemporalFfx(ROWS, COLS, clamp=9.0) for _ in range(2))
    for picture in (noise, constant(1), noise):
        found = forgetful.next_frame(picture, surface, back)
    for picture in (constant(1), noise):
        expected = begun.next_frame(picture, surface, back)
    assert np.array_equal(found, expected)


def test_a_wall_of_one_pixel_in_width():
    depth, normal = (image[:, :1] for image in wall())
    picture = np.float32(np.arange(HEIGHT)[:, None] % 2)
    found = ffx(picture, depth, normal)
    assert found.shape == (HEIGHT, 1) and found.std() < picture.std() / 2

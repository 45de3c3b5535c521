"""Moments of a light's map, filtered: what is known of constant depths, edges and seams."""

import numpy as np
import pytest

from neural_shadows.shadow_maps.filtered_moments import filtered_moments
from neural_shadows.shadow_maps.light_map import cube_map, perspective_map
from neural_shadows.shadow_maps.moments import (
    box,
    exponential_visibility,
    gaussian,
    hamburger_visibility,
    powers,
    variance_visibility,
    warped,
)

CENTRE, FAR = np.zeros(3), 8.0
METHODS = {
    "variance": (lambda depth: powers(depth, 2), variance_visibility),
    "exponential": (warped, exponential_visibility),
    "four moments": (lambda depth: powers(depth, 4), hamburger_visibility),
}
MAPS = {
    "cube": cube_map(CENTRE, 16),
    "picture": perspective_map(CENTRE, np.array([0, 0, 1.0]), 90.0, 16),
}
KERNELS = {"box": box(3), "gaussian": gaussian(15, 3.0)}


def directions(count=500):
    from_light = np.random.default_rng(0).normal(size=(count, 3))
    return from_light / np.linalg.norm(from_light, axis=1, keepdims=True)


@pytest.mark.parametrize("kernel", KERNELS)
@pytest.mark.parametrize("kind", MAPS)
@pytest.mark.parametrize("name", METHODS)
def test_constant_depth_is_lit_everywhere_and_dark_behind(name, kind, kernel):
    of, visibility = METHODS[name]
    light_map, from_light = MAPS[kind], directions()
    depths = np.full(light_map.count, 2, np.float32)
    moments = filtered_moments(
        light_map, depths, from_light, of=of, far=FAR, kernel=KERNELS[kernel]
    )
    on_map = light_map.texels_of(from_light) >= 0
    assert np.allclose(moments[on_map], of(np.array([2 / FAR])))
    assert visibility(moments, np.full(len(from_light), 1.99 / FAR)).min() > 0.99
    behind = visibility(moments, np.full(len(from_light), 3 / FAR))
    assert behind[on_map].max() < 0.02 and np.all(behind[~on_map] > 0.99)


def test_texels_that_see_nothing_are_far():
    light_map = MAPS["picture"]
    depths = np.full(light_map.count, np.inf, np.float32)
    moments = filtered_moments(
        light_map, depths, np.array([[0, 0, 1.0]]), of=warped, far=FAR, kernel=box(9)
    )
    assert np.allclose(moments, warped(np.ones(1)))


def test_an_edge_is_half_lit_and_shadow_grows_behind_it():
    """At the far depth of two each method is exact: the share of the kernel that is there."""
    light_map = perspective_map(CENTRE, np.array([0, 0, 1.0]), 90.0, 64)
    right = light_map.directions_of(np.arange(light_map.count))[:, 0] > 0
    texels = np.linspace(-8, 8, 65)
    from_light = np.stack([texels / 32, np.full_like(texels, 0.013), np.ones_like(texels)], axis=1)
    depths = np.where(right, 2, 5).astype(np.float32)
    for of, visibility in METHODS.values():
        moments = filtered_moments(light_map, depths, from_light, of=of, far=FAR, kernel=box(9))
        lit = visibility(moments, np.full(len(from_light), 5 / FAR))
        assert np.allclose(lit, np.clip(0.5 - texels / 9, 0, 1), atol=5e-3)


def test_moments_go_on_over_a_seam():
    """Of a depth that is smooth in direction: no step from one face to the next."""
    cube = cube_map(CENTRE, 64)
    from_light = cube.directions_of(np.arange(cube.count))
    depths = (3 + from_light @ np.array([0.9, 0.4, -0.6])).astype(np.float32)
    around = np.radians(45 + np.array([-1e-4, 1e-4]))
    for height in (-0.5, 0.1, 0.7):
        pair = np.stack([np.sin(around), np.full(2, height), np.cos(around)], axis=1)
        assert len(np.unique(cube.places_of(pair)[0])) == 2
        (before, after), (low, high) = (
            filtered_moments(
                cube, depths, at, of=lambda depth: powers(depth, 4), far=FAR, kernel=box(9)
            )
            for at in (pair, pair + [[-0.02, 0, 0.02], [0.02, 0, -0.02]])
        )
        # A texel further to each side it differs by far more.
        assert np.abs(before - after).max() < 0.1 * np.abs(low - high).max()

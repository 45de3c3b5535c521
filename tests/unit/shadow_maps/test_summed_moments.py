"""Means of windows of any width, beside sums of their texels."""

import numpy as np
import pytest

from neural_shadows.shadow_maps.light_map import cube_map, perspective_map
from neural_shadows.shadow_maps.moments import powers
from neural_shadows.shadow_maps.summed_moments import summed_views

SIZE, FAR = 32, 8.0
MAPS = {
    "cube": cube_map(np.zeros(3), SIZE),
    "picture": perspective_map(np.zeros(3), np.array([0, 0, 1.0]), 90.0, SIZE),
}


def views_of(light_map, depths, from_light, widest):
    def of(depth):
        return powers(depth, 4)

    widest = np.full(len(from_light), widest)
    return [*summed_views(light_map, depths, from_light, of=of, far=FAR, widest=widest)]


def test_windows_hold_their_texels_and_parts_of_them():
    """Of a receiver in a texel's middle: whole texels within, half ones at the rim."""
    light_map = MAPS["picture"]
    depths = np.random.default_rng(0).uniform(1, 7, light_map.count).astype(np.float32)
    texel = 13 * SIZE + 17
    [view] = views_of(light_map, depths, light_map.directions_of(np.array([texel])), 0.4)
    picture = powers(depths.reshape(SIZE, SIZE) / np.float32(FAR), 4)
    three = picture[12:15, 16:19].mean(axis=(0, 1))
    assert np.allclose(view.means(np.array([[3.0, 3.0]]))[0], three, rtol=1e-5)
    weights = np.array([0.5, 1, 0.5]) / 2
    two = np.einsum("i,j,ijk->k", weights, weights, picture[12:15, 16:19])
    assert np.allclose(view.means(np.array([[2.0, 2.0]]))[0], two, rtol=1e-5)


@pytest.mark.parametrize("kind", MAPS)
def test_any_width_of_a_constant_depth(kind):
    light_map = MAPS[kind]
    from_light = light_map.directions_of(np.arange(light_map.count))
    seen = 0
    for view in views_of(light_map, np.full(light_map.count, 2, np.float32), from_light, 0.5):
        for tangent in (0.0, 0.01, 0.1, 0.5, 5.0):
            sides = view.sides(np.full(len(view.receivers), tangent))
            assert sides.min() >= 1
            assert np.allclose(view.means(sides), powers(np.array([2 / FAR]), 4), rtol=1e-9)
        seen += len(view.receivers)
    assert seen == len(from_light)


def test_a_window_has_the_area_of_its_disc():
    """Texels whose directions lie within the disc, in the middle and towards a corner (4 % more)."""
    light_map, tangent = perspective_map(np.zeros(3), np.array([0, 0, 1.0]), 90.0, 256), 0.1
    for place in (128 * 256 + 128, 48 * 256 + 208):
        centre = light_map.directions_of(np.array([place]))
        [view] = views_of(light_map, np.ones(light_map.count, np.float32), centre, tangent)
        cosines = light_map.directions_of(np.arange(light_map.count)) @ centre[0]
        within = np.sum(np.sqrt(1 / cosines[cosines > 0] ** 2 - 1) < tangent)
        along = view.sides(np.array([tangent]))[0]
        assert along.prod() == pytest.approx(within, rel=0.06)

"""Filtered maps of a light at a place beside the half-plane's closed form."""

import numpy as np
import pytest
import trimesh
from half_planes import CENTRE, half_plane, share_seen
from shapes import prepared, sheet

from neural_shadows.shadow_maps.light_filters import (
    disc_visibility,
    hard_visibility,
    receiver_bias,
    soft_disc_visibility,
)
from neural_shadows.shadow_maps.light_map import cube_map, perspective_map

EDGE, RADIUS = 1.5, 0.3
MAPS = {
    "cube": cube_map(CENTRE, 1024),
    "picture": perspective_map(CENTRE, np.array([0, -1.0, 0]), 90.0, 1024),
}


def half_plane_scene():
    """Ground at 0, and x > 0 covered at `EDGE`."""
    return prepared(trimesh.util.concatenate([sheet(0.0, 30.0), half_plane(EDGE)]))[1]


@pytest.fixture(scope="module")
def receivers():
    """Of the ground, from well lit to well covered: from_light from the light, biases, keys, x."""
    x = np.linspace(-0.6, 0.6, 241)
    points = np.stack([x, np.zeros_like(x), np.full_like(x, 0.05)], axis=1)
    from_light = points - CENTRE
    cosines = -from_light[:, 1] / np.linalg.norm(from_light, axis=1)
    return from_light, cosines, np.arange(len(x)), x


@pytest.mark.parametrize("name", MAPS)
def test_hard_shadow_of_a_half_plane(name, receivers):
    from_light, cosines, _, x = receivers
    light_map, tracer = MAPS[name], half_plane_scene()
    bias = receiver_bias(light_map, from_light, cosines, 60.0)
    lit = hard_visibility(light_map, light_map.depths(tracer), from_light, bias)
    texel = light_map.texel_size(np.array([[0, -1.0, 0]]))[0] * CENTRE[1]
    sure = np.abs(x) > 2 * texel
    assert np.array_equal(lit[sure], (x < 0)[sure])


@pytest.mark.parametrize("name", MAPS)
def test_blocker_search_finds_the_penumbra_of_a_half_plane(name, receivers):
    """One edge, one distance: there the method is exact but for its samples and texels."""
    from_light, cosines, keys, x = receivers
    light_map, tracer = MAPS[name], half_plane_scene()
    depths = light_map.depths(tracer)
    ground = np.tile([0.0, 1.0, 0.0], (len(from_light), 1))
    bias = receiver_bias(light_map, from_light, cosines, 60.0)
    told = {"radius": RADIUS, "keys": keys}
    found = soft_disc_visibility(
        light_map, depths, from_light, ground, bias, **told, searched=256, samples=512
    )
    expected = share_seen(x, EDGE, RADIUS)
    assert expected.min() == 0 and expected.max() == 1
    assert np.abs(found - expected).max() < 0.05
    assert abs((found - expected).mean()) < 0.01
    # A filter of one width has the same shadow's middle, and another width.
    even = disc_visibility(
        light_map, depths, from_light, ground, bias, texels=4, samples=64, keys=keys
    )
    assert abs(np.interp(0.5, even[::-1], x[::-1])) < 0.01
    assert ((even > 0.05) & (even < 0.95)).sum() < ((found > 0.05) & (found < 0.95)).sum() / 2


def test_a_point_light_has_no_penumbra(receivers):
    from_light, cosines, keys, _ = receivers
    light_map, tracer = MAPS["cube"], half_plane_scene()
    depths = light_map.depths(tracer)
    bias = receiver_bias(light_map, from_light, cosines, 60.0)
    ground = np.tile([0.0, 1.0, 0.0], (len(from_light), 1))
    soft = soft_disc_visibility(light_map, depths, from_light, ground, bias, radius=0.0, keys=keys)
    hard = hard_visibility(light_map, depths, from_light, bias)
    assert np.mean(np.abs(soft - hard) > 0.6) < 0.01  # a texel is its least width


@pytest.mark.parametrize("name", MAPS)
def test_slanted_ground_is_lit_by_a_wide_light(name):
    """Discs as wide as a metre of ground aslant: none of it lies before its own plane."""
    light_map, tracer = MAPS[name], prepared(sheet(0.0, 30.0))[1]
    x = np.linspace(-6, 6, 101)
    from_light = np.stack([x, np.zeros_like(x), x / 3], axis=1) - CENTRE
    from_light = from_light[light_map.texels_of(from_light) >= 0]
    cosines = -from_light[:, 1] / np.linalg.norm(from_light, axis=1)
    assert cosines.min() < 0.75
    bias = 0.3 * receiver_bias(light_map, from_light, cosines, 60.0)
    ground, keys = np.tile([0.0, 1.0, 0.0], (len(from_light), 1)), np.arange(len(from_light))
    depths = light_map.depths(tracer)
    soft = soft_disc_visibility(light_map, depths, from_light, ground, bias, radius=0.8, keys=keys)
    even = disc_visibility(
        light_map, depths, from_light, ground, bias, texels=40, samples=64, keys=keys
    )
    assert soft.min() == 1 and even.min() == 1

"""Filtering over k × k texels: half-planes in closed form, and the seams of a cube."""

import numpy as np
import pytest

from neural_shadows.shadow_maps.box_filter import box_visibility
from neural_shadows.shadow_maps.light_map import LightMap, cube_map, perspective_map

CENTRE = np.zeros(3)


def facing(from_light):
    """Normals of receivers that face the light."""
    return -from_light / np.linalg.norm(from_light, axis=1, keepdims=True)


def half_plane(light_map):
    """Depths of a map: 1 where x > 0, which hides what is at 2."""
    from_light = light_map.directions_of(np.arange(light_map.count))
    return np.where(from_light[:, 0] > 0, 1, 10).astype(np.float32)


@pytest.mark.parametrize("size", [1, 3, 15])
def test_a_half_plane_fades_over_the_kernels_width(size):
    """Exactly: bilinear tests averaged over k texels make a ramp of k texels."""
    light_map = perspective_map(CENTRE, np.array([0, 0, 1.0]), 90.0, 64)
    texels = np.linspace(-12, 12, 193)  # across the edge
    from_light = (
        np.stack([texels / 32, np.full_like(texels, 0.013), np.ones_like(texels)], axis=1) * 2
    )
    receivers = from_light, facing(from_light), np.zeros(len(from_light))
    lit = box_visibility(light_map, half_plane(light_map), *receivers, size=size)
    assert np.allclose(lit, np.clip(0.5 - texels / size, 0, 1), atol=1e-6)


def test_bias_lets_receivers_lie_behind():
    light_map = perspective_map(CENTRE, np.array([0, 0, 1.0]), 90.0, 8)
    from_light = np.array([[0.1, 0.1, 1.0], [0.1, 0.1, 1.0], [5.0, 0, 1.0]])
    wall = light_map.directions_of(np.arange(64))
    depths = (0.99 / wall[:, 2]).astype(np.float32)  # flat, a hundredth before the receivers
    normals = np.array([[0, 0, -1.0]] * 3)
    lit = box_visibility(light_map, depths, from_light, normals, np.array([0.02, 0, 0]), size=3)
    assert lit.tolist() == [1, 0, 1]  # the last is off the map


def all_round(count, seed=0):
    """Directions that keep clear of a cube's corners, where three faces share a kernel."""
    from_light = np.random.default_rng(seed).normal(size=(count, 3))
    from_light /= np.abs(from_light).max(1, keepdims=True)
    return from_light[np.sort(np.abs(from_light), axis=1)[:, 0] < 0.6]


def test_kernels_go_on_over_a_cubes_seams():
    """As in one wide picture of the same texels, looked up one by one by their direction."""
    cube = cube_map(CENTRE, 32)
    depths = np.random.default_rng(1).uniform(1, 2, cube.count).astype(np.float32)
    from_light = all_round(4000)
    from_light *= 1.5 / np.linalg.norm(from_light, axis=1, keepdims=True)
    faces, places = cube.places_of(from_light)
    assert ((places < 4) | (places > 28)).any(1).sum() > 200
    bias = np.zeros(len(from_light))
    normals = facing(from_light)
    lit = box_visibility(cube, depths, from_light, normals, bias, size=9)
    for face in range(6):
        wide = LightMap(CENTRE, cube.faces[face : face + 1], 2.0, 64)
        texels = cube.texels_of(wide.directions_of(np.arange(wide.count)))
        there = faces == face
        receivers = from_light[there], normals[there], bias[there]
        one = box_visibility(wide, depths[texels], *receivers, size=9)
        assert np.allclose(lit[there], one, atol=1e-5)


def test_a_turned_cube_tells_the_same():
    """An edge along a seam, where the kernel lies on two faces, and in the middle of a face."""
    angle = np.radians(45)
    turn = np.array([[np.cos(angle), 0, -np.sin(angle)], [0, 1, 0], [np.sin(angle), 0, 0.7071]])
    cube = cube_map(CENTRE, 128)
    turned = LightMap(CENTRE, cube.faces @ turn.T, 1.0, 128)
    around = np.radians(np.linspace(30, 60, 121))
    from_light = 2 * np.stack([np.sin(around), np.full_like(around, 0.1), np.cos(around)], axis=1)
    lit = []
    for light_map in (cube, turned):
        texels = light_map.directions_of(np.arange(light_map.count))
        depths = np.where(texels[:, 0] > texels[:, 2], 1, 10).astype(np.float32)
        receivers = from_light, facing(from_light), np.zeros(len(from_light))
        lit.append(box_visibility(light_map, depths, *receivers, size=9))
    seam, middle = lit
    # A texel at a seam is narrower than one in the middle, by the cosine of 45 degrees squared.
    centres = [np.interp(0.5, 1 - answer, around) for answer in lit]
    assert np.allclose(centres, angle, atol=np.radians(0.2))
    widths = [((answer > 0.05) & (answer < 0.95)).sum() for answer in lit]
    assert 0.4 < widths[0] / widths[1] < 0.6
    for answer in lit:
        assert np.all(np.diff(answer) <= 1e-6) and answer[0] == 1 and answer[-1] == 0


@pytest.mark.parametrize("tilt", [0, 45, 75])
def test_a_slanted_plane_does_not_shadow_itself(tilt):
    """Against the receiver's own distance half of a kernel on a slope would hide it."""
    light_map, angle = perspective_map(CENTRE, np.array([0, 0, 1.0]), 60.0, 64), np.radians(tilt)
    normal = np.array([np.sin(angle), 0, -np.cos(angle)])
    to_texels = light_map.directions_of(np.arange(light_map.count)).astype(np.float64)
    depths = (2 * normal[2] / (to_texels @ normal)).astype(np.float32)  # through (0, 0, 2)
    points = np.stack([np.linspace(-0.2, 0.2, 101), np.full(101, 0.013), np.zeros(101)], axis=1)
    points[:, 2] = 2 + points[:, 0] * np.tan(angle)
    normals, bias = np.tile(normal, (101, 1)), np.full(101, 1e-5)
    assert box_visibility(light_map, depths, points, normals, bias, size=9).min() == 1
    behind = points * 1.001
    assert box_visibility(light_map, depths, behind, normals, bias, size=9).max() == 0

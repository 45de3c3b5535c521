"""Maps of a light at a place: each direction finds the texel that looks along it."""

import numpy as np
import pytest
import trimesh
from shapes import prepared

from neural_shadows.shadow_maps.light_map import cube_map, perspective_map

CENTRE = np.array([0.3, -0.2, 0.1])
MAPS = {
    "cube": cube_map(CENTRE, 16),
    "perspective": perspective_map(CENTRE, np.array([1.0, -2, 0.5]), 110.0, 16),
}


@pytest.mark.parametrize("name", MAPS)
def test_a_texels_direction_lies_in_it(name):
    texels = np.arange(MAPS[name].count)
    directions = MAPS[name].directions_of(texels)
    assert np.allclose(np.linalg.norm(directions, axis=1), 1, atol=1e-6)
    assert np.array_equal(MAPS[name].texels_of(3 * directions), texels)


def test_a_cube_sees_all_round_and_a_picture_its_angle():
    directions = np.random.default_rng(0).normal(size=(5000, 3))
    cube, picture = (MAPS[name].texels_of(directions) for name in ("cube", "perspective"))
    assert cube.min() >= 0 and len(np.unique(cube)) > 1000
    forward = np.array([1.0, -2, 0.5]) / np.linalg.norm([1.0, -2, 0.5])
    cosine = directions @ forward / np.linalg.norm(directions, axis=1)
    # A cone of 55 degrees fits in the picture, and nothing past its corners does.
    assert np.all(picture[cosine > np.cos(np.radians(55))] >= 0)
    assert np.all(picture[cosine < np.cos(np.arctan(np.sqrt(2) * np.tan(np.radians(55))))] == -1)


def test_distances_to_a_sphere_round_the_light():
    ball = trimesh.creation.icosphere(5, radius=2.0)
    ball.apply_translation(CENTRE)
    _, tracer = prepared(ball)
    for light_map in MAPS.values():
        assert np.allclose(light_map.depths(tracer), 2, atol=2e-3)
    some = np.array([5, 700, 31])
    found = MAPS["cube"].depths(tracer, some)
    assert np.array_equal(found, MAPS["cube"].depths(tracer)[some])


def test_texels_cover_the_sphere():
    """Their sizes, squared and lessened by the slant, add up to its whole angle."""
    light_map = cube_map(CENTRE, 32)
    directions = light_map.directions_of(np.arange(light_map.count)).astype(float)
    along = np.abs(directions).max(1)
    angles = light_map.texel_size(directions).astype(float) ** 2 * along
    assert angles.sum() == pytest.approx(4 * np.pi, rel=2e-3)

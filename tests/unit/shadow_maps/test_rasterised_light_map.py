"""Rasterised maps of a light at a place beside traced ones."""

import numpy as np
import pytest

from neural_shadows.scenes.arrangement import scene_of
from neural_shadows.scenes.generated import arrange
from neural_shadows.shadow_maps.light_map import cube_map, perspective_map
from neural_shadows.shadow_maps.neighbourhood import neighbourhood
from neural_shadows.shadow_maps.rasterised_light_map import rasterised_depths


@pytest.mark.parametrize("name", ["room", "tree"])
def test_a_z_buffer_finds_what_rays_find(name):
    """The light stands amid the scene: many triangles pass through the plane of each face."""
    arrangement = arrange(name, 5)
    scene = scene_of(arrangement)
    centre = (arrangement.lights.low + arrangement.lights.high) / 2 - [0, 1.2, 0]
    for light_map in (cube_map(centre, 128), perspective_map(centre, [0.2, -1, 0.1], 120, 128)):
        traced = light_map.depths(scene.tracer)
        drawn = rasterised_depths(light_map, scene.joined.vertices, scene.joined.faces)
        with np.errstate(invalid="ignore"):
            same = (traced == drawn) | (np.abs(traced - drawn) < 1e-3 * traced)
        assert same.mean() > 0.9995
        assert np.isfinite(traced).mean() > 0.15


def test_neighbourhoods():
    """Inside a face the texels are a square; over an edge they are those along the same directions."""
    light_map = cube_map(np.zeros(3), 16)
    rng = np.random.default_rng(0)
    directions = rng.normal(size=(2000, 3)).astype(np.float32)
    texels, fractions = neighbourhood(light_map, directions, reach=1)
    assert texels.shape == (2000, 4, 4) and texels.min() >= 0
    assert fractions.min() >= 0 and fractions.max() < 1
    nearest = light_map.texels_of(directions)
    right, down = (fractions > 0.5).astype(int).T
    heaviest = texels[np.arange(2000), 1 + down, 1 + right]
    row, column = nearest // 16 % 16, nearest % 16
    inner = (row > 1) & (row < 14) & (column > 1) & (column < 14)
    assert np.array_equal(heaviest[inner], nearest[inner])
    # Every texel of a neighbourhood looks nearly the same way.
    unit = directions / np.linalg.norm(directions, axis=1, keepdims=True)
    looks = light_map.directions_of(texels.ravel()).reshape(-1, 4, 4, 3)
    assert np.einsum("nabk,nk->nab", looks, unit).min() > np.cos(np.radians(24))
    outside = neighbourhood(
        perspective_map(np.zeros(3), [0, -1, 0], 60, 8), -directions * 0 + [0, 1, 0], 1
    )
    assert np.all(outside[0] == -1)

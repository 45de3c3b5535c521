"""Discs of directions in a light's map beside the same samples one by one in numpy."""

import numpy as np
import pytest

from neural_shadows.shadow_maps.light_discs import vogel_disc
from neural_shadows.shadow_maps.light_filters import disc_visibility, soft_disc_visibility
from neural_shadows.shadow_maps.light_map import cube_map, perspective_map

CENTRE = np.zeros(3)
MAPS = {
    "cube": cube_map(CENTRE, 64),
    "picture": perspective_map(CENTRE, np.array([1.0, 2.0, 3.0]), 110.0, 64),
}
RADIUS, NEAREST = 0.15, 0.5


@pytest.fixture(scope="module", params=MAPS)
def seen(request):
    """A map of noise with holes, and receivers all round: from_light, normals, biases, keys."""
    light_map, rng = MAPS[request.param], np.random.default_rng(3)
    depths = rng.uniform(0.6, 1.4, light_map.count).astype(np.float32)
    depths[rng.random(light_map.count) < 0.1] = np.inf
    from_light = rng.normal(size=(3000, 3)).astype(np.float32)
    from_light /= np.linalg.norm(from_light, axis=1, keepdims=True)
    normals = rng.normal(size=(3000, 3)) - 2 * from_light  # most face the light, some aslant
    normals = (normals / np.linalg.norm(normals, axis=1, keepdims=True)).astype(np.float32)
    receivers = from_light, normals, np.full(len(from_light), 0.01, np.float32)
    return light_map, depths, receivers, rng.permutation(3000)


def samples_of(light_map, from_light, angles, keys, count):
    """Texels that discs look up, (n, count), and which discs lie within one face."""
    x, y, z = from_light.T.astype(np.float64)
    sign = np.where(z >= 0, 1, -1)
    a = -1 / (sign + z)
    one = np.stack([1 + sign * x * x * a, sign * x * y * a, -sign * x], axis=1)
    two = np.stack([x * y * a, sign + y * y * a, -y], axis=1)
    turn = 2 * np.pi * (keys * 0.6180339887498949 % 1)[:, None]
    u, v = np.cos(turn) * one + np.sin(turn) * two, np.cos(turn) * two - np.sin(turn) * one
    p, q = vogel_disc(count).astype(np.float64)[:, None, :, None] * angles[:, None, None]
    directions = (from_light[:, None] + p * u[:, None] + q * v[:, None]).reshape(-1, 3)
    faces = light_map.places_of(directions)[0].reshape(len(from_light), count)
    whole = (faces == faces[:, :1]).all(1) & (faces[:, 0] >= 0)
    return light_map.texels_of(directions).reshape(len(from_light), count), whole


def hidden(light_map, depths, texels, receivers):
    """Which samples lie before their receiver's plane, and their depths."""
    from_light, normals, bias = (one.astype(np.float64) for one in receivers)
    depth = np.where(texels < 0, np.inf, depths[texels])
    to_texels = light_map.directions_of(np.maximum(texels, 0).ravel()).astype(np.float64)
    there = np.einsum("nkj,nj->nk", to_texels.reshape(*texels.shape, 3), normals)
    ratio = np.clip(there / np.einsum("nj,nj->n", from_light, normals)[:, None], 0.5, 2)
    return 1 / ratio - bias[:, None] > depth, depth


def of_facing(shares, receivers):
    """0 of receivers that are turned from the light."""
    from_light, normals, _ = receivers
    return np.where(np.einsum("ij,ij->i", from_light, normals) < 0, shares, 0)


@pytest.mark.parametrize("radius", [0.5, 12.0])
def test_discs_within_a_face_and_over_its_rim(seen, radius):
    """Each a whole number of samples: another at a texel's border, where float32 rounds."""
    light_map, depths, receivers, keys = seen
    from_light = receivers[0]
    found = disc_visibility(light_map, depths, *receivers, texels=radius, samples=64, keys=keys)
    angles = np.full(len(from_light), radius * 2 * light_map.half / light_map.resolution)
    texels, whole = samples_of(light_map, from_light, angles, keys, 64)
    lit = 1 - hidden(light_map, depths, texels, receivers)[0].mean(1)
    wrong = found - of_facing(lit, receivers)
    for some in (whole, ~whole):
        assert some.sum() > 100
        # Planes at grazing angles are cut off along the face's axis there, radially here.
        assert np.mean(np.abs(wrong[some]) > 1e-6) < 0.04
        assert np.abs(wrong[some]).max() < 2.5 / 64


def test_blocker_search_within_a_face_and_over_its_rim(seen):
    light_map, depths, receivers, keys = seen
    from_light = receivers[0]
    told = {"radius": RADIUS, "nearest": NEAREST, "searched": 32, "samples": 64, "keys": keys}
    found = soft_disc_visibility(light_map, depths, *receivers, **told)
    distance = np.linalg.norm(from_light, axis=1)
    first = light_map.near + NEAREST * (distance - light_map.near)
    widest = RADIUS * (1 / first - 1 / distance)
    texels, _ = samples_of(light_map, from_light, widest, keys, 32)
    blocks, depth = hidden(light_map, depths, texels, receivers)
    blocker = np.where(blocks, depth, 0).sum(1) / np.maximum(blocks.sum(1), 1)
    angles = RADIUS * (distance - blocker) / (distance * np.maximum(blocker, 0.1))
    angles = np.maximum(angles, light_map.half / light_map.resolution)
    texels, whole = samples_of(light_map, from_light, angles, keys, 64)
    lit = np.where(blocks.any(1), 1 - hidden(light_map, depths, texels, receivers)[0].mean(1), 1)
    lit = of_facing(lit, receivers)
    assert 0 < np.mean((lit > 0) & (lit < 0.7)) and lit.max() == 1
    for some in (whole, ~whole):
        assert some.sum() > 100
        assert np.mean(np.abs(found - lit)[some] > 1e-6) < 0.02
        assert abs((found - lit)[some].mean()) < 1e-3

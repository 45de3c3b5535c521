"""A city that is a solid, a terrain that is a sheet; the same from a seed."""

import numpy as np
import pytest
import trimesh

from neural_shadows.meshes.city import make_city
from neural_shadows.meshes.normalised import normalised
from neural_shadows.meshes.terrain import HIGHEST, SIDE, make_terrain


@pytest.mark.parametrize(
    ("make", "size"), [(make_city, {"blocks": 2}), (make_terrain, {"cells": 64})]
)
def test_a_seed_decides(make, size):
    vertices, faces = make(**size, seed=1)
    again, other = make(**size, seed=1), make(**size, seed=2)
    assert np.array_equal(vertices, again[0]) and np.array_equal(faces, again[1])
    assert not np.array_equal(vertices[:100], other[0][:100])


@pytest.mark.parametrize("blocks", [1, 2, 3])
def test_a_city_is_a_solid_wound_outward(blocks):
    city = trimesh.Trimesh(*make_city(blocks=blocks, seed=3), process=False)
    assert city.volume > 0 and city.bounds[0][1] == pytest.approx(-3)
    assert 15 < city.bounds[1][1] < 80  # metres
    # From above every first hit is a face that looks up.
    low, high = city.bounds
    places = np.random.default_rng(0).uniform(low, high, (3000, 3))
    places[:, 1] = high[1] + 1
    _, _, face = city.ray.intersects_location(
        places, np.tile([0, -1.0, 0], (3000, 1)), multiple_hits=False
    )
    assert len(face) > 1500 and np.mean(city.face_normals[face, 1] > 0) > 0.999
    assert not normalised(city.vertices, city.faces, "city").sheet


def test_a_terrain_is_a_sheet_that_looks_up():
    vertices, faces = make_terrain(cells=128, seed=3)
    assert vertices.shape == (129**2, 3) and faces.shape == (2 * 128**2, 3)
    assert np.ptp(vertices[:, 0]) == np.ptp(vertices[:, 2]) == SIDE
    assert HIGHEST < vertices[:, 1].max() < HIGHEST + 20
    land = trimesh.Trimesh(vertices, faces, process=False)
    assert np.all(land.face_normals[:, 1] > 0)
    assert normalised(vertices, faces, "terrain").sheet
    # Ridges and valleys, no plain: a third of it is steeper than 20°.
    assert np.mean(land.face_normals[:, 1] < np.cos(np.radians(20))) > 0.3

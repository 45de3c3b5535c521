"""Walks of cones past a sphere and the edge of a slab, where what is hidden of a disc is known.

One walk takes what is deep across its way for deeper than it is: fields of thin objects need that.
"""

import numpy as np
import pytest
import trimesh
from shapes import prepared

from neural_shadows.evaluation.method_parts.object_field import fitted_field
from neural_shadows.representations.distance_bricks.field_cones import (
    above_plane,
    dim_by_field,
    half_disc,
    split_disc,
)

SLOPE, FAR, DROP = 0.1, 50.0, 3.0  # of the light, its distance, and the points' below the objects
UP = np.array([0, 0, 1], np.float32)


def disc_points(count):
    """Spread over the unit disc, (count, 2)."""
    k = np.arange(count) + 0.5
    angle = k * np.pi * (3 - 5**0.5)
    return np.sqrt(k / count)[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def points_below(x):
    points = np.zeros((len(x), 3), np.float32)
    points[:, 0], points[:, 2] = x, -DROP
    return points


def past_sphere(point, rays):
    """Rays from a point that miss the unit sphere."""
    along = rays @ -point / np.linalg.norm(rays, axis=1)
    return point @ point - along**2 > 1


def past_slab(point, rays):
    """Rays that miss x < 1.5 between z = −0.1 and 0.1."""
    at = [point[0] + rays[:, 0] * (DROP + z) for z in (-0.1, 0.1)]
    return np.minimum(*at) > 1.5


SPHERE = trimesh.creation.icosphere(4), past_sphere
SLAB = trimesh.creation.box((3, 3, 0.2)), past_slab


def marched(shape, x, walks, push=0.0, cell=0.04):
    field = fitted_field(prepared(shape)[0], cell)
    points = points_below(x)
    to_light, normals = np.tile(FAR * UP, (len(x), 1)), np.tile(UP, (len(x), 1))
    visible = above_plane(normals, to_light, np.float32(SLOPE * FAR))
    around = field.centre.astype(np.float32), np.float32(field.radius), field.cone_field
    arguments = split_disc(walks), np.float32(push)
    dim_by_field(points, normals, to_light, np.float32(SLOPE * FAR), *around, *arguments, visible)
    return visible


@pytest.mark.parametrize("shape, past", [SPHERE, SLAB], ids=["sphere", "slab"])
@pytest.mark.parametrize("walks, most", [(1, 0.25), (8, 0.04)])
def test_visibility_past_an_edge(shape, past, walks, most):
    x = np.linspace(0.2, 2.4, 60)
    disc = disc_points(4000)
    rays = np.column_stack([SLOPE * disc, np.ones(len(disc))])
    exact = np.array([np.mean(past(point, rays)) for point in points_below(x)])
    assert exact[0] == 0 and exact[-1] == 1 and np.mean((exact > 0) & (exact < 1)) > 0.15
    result = marched(shape, x, walks)
    assert np.abs(result - exact).max() < most and np.abs(result - exact).mean() < most / 4
    assert result[0] < 0.03 and result[-1] == 1


def test_splitting_resolves_a_rod():
    """One walk knows one edge; the rod covers the middle of the light, 2 · 0.036 / 0.3 of its width."""
    rod = trimesh.creation.box((0.072, 2, 0.072))
    disc = SLOPE * DROP * disc_points(4000)
    exact = np.mean(np.abs(disc[:, 0]) > 0.036)
    single, eight = (marched(rod, np.zeros(1), walks, cell=0.01)[0] for walks in (1, 8))
    assert abs(eight - exact) < 0.08 < abs(single - exact)


def test_pushing_out_lowers_visibility():
    x = np.linspace(1.0, 1.4, 20)
    plain, pushed = (marched(SPHERE[0], x, 1, push) for push in (0.0, 2.0))
    assert np.all(pushed <= plain) and pushed.sum() < plain.sum() - 0.1


def test_a_plane_hides_its_side_of_the_light_once():
    """Of a point on an object, the object's own face does not hide that part of the light again."""
    tilts = np.array([-2, -0.5, 0, 0.5, 2]) * SLOPE
    normals = np.stack([np.ones(5), np.zeros(5), tilts], axis=1).astype(np.float32)
    to_light = np.tile(FAR * UP, (5, 1))
    size = np.float32(SLOPE * FAR)
    visible = above_plane(normals, to_light, size)
    exact = [0, 0.1955, 0.5, 0.8045, 1]  # segments of a disc
    np.testing.assert_allclose(visible, exact, atol=1e-3)
    field = fitted_field(prepared(trimesh.creation.box((1, 1, 1)))[0], 0.01)
    points = np.tile(np.array([5, 5, 0], np.float32), (5, 1))
    arguments = field.centre, field.radius, field.cone_field, split_disc(1), np.float32(0)
    dim_by_field(points, normals, to_light, size, *arguments, visible)
    np.testing.assert_allclose(visible, exact, atol=1e-3)


@pytest.mark.parametrize("count", [4, 8])
def test_the_parts_of_a_disc_are_spread_as_it_is(count):
    centres = split_disc(count)
    spread = (centres**2).mean(0) + 1 / (4 * count)
    np.testing.assert_allclose(spread, 0.25, atol=1e-6)
    np.testing.assert_allclose(centres.mean(0), 0, atol=1e-6)


def test_the_share_of_a_disc():
    disc = disc_points(20_000)
    for m in (-1.2, -0.6, 0.0, 0.3, 0.9, 1.0):
        assert abs(half_disc(np.float32(m)) - np.mean(disc[:, 0] < m)) < 2e-3

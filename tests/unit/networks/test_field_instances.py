"""Ways among copies of fields, beside Embree on all their triangles."""

import numpy as np
import pytest
import trimesh
from shapes import box, bumpy_sphere
from trimesh.transformations import random_rotation_matrix

from neural_shadows.networks.object_space.field_bricks import FieldBricks
from neural_shadows.networks.object_space.field_instances import FieldInstances
from neural_shadows.networks.object_space.untrained_field import untrained_field
from neural_shadows.scenes.tracing import Tracer

SHAPES = [bumpy_sphere(4), box(0.9, 0.3, 1.3), trimesh.creation.torus(0.7, 0.15)]


@pytest.fixture(scope="module")
def fields(tmp_path_factory) -> list[FieldBricks]:
    found = []
    for number, shape in enumerate(SHAPES):
        path = tmp_path_factory.mktemp("meshes") / f"{number}.ply"
        shape.export(path)
        found.append(untrained_field(path, 128))
    return found


def placed(kinds, rng) -> np.ndarray:
    """Anywhere in a cube of side 6, turned and scaled at random."""
    found = np.stack([random_rotation_matrix(rng.random(3)) for _ in kinds])
    found[:, :3, :3] *= rng.uniform(0.3, 0.8, (len(kinds), 1, 1))
    found[:, :3, 3] = rng.uniform(-3, 3, (len(kinds), 3))
    return found


def traced(kinds, placements) -> Tracer:
    shapes = [SHAPES[kind].copy().apply_transform(one) for kind, one in zip(kinds, placements)]
    whole = trimesh.util.concatenate(shapes)
    return Tracer(whole.vertices, whole.faces)


def some_ways(count, rng) -> tuple[np.ndarray, np.ndarray]:
    points, goals = rng.uniform(-4, 4, (2, count, 3))
    return points.astype(np.float32), (goals - points).astype(np.float32)


@pytest.mark.parametrize("count", [1, 2, 40])
def test_copies_block_what_their_triangles_do(fields, count):
    rng = np.random.default_rng(count)
    kinds = rng.integers(3, size=count)
    placements = placed(kinds, rng)
    instances, tracer = FieldInstances(fields, kinds, placements), traced(kinds, placements)
    points, ways = some_ways(20_000, rng)
    for found, exact in (
        (instances.blocked(points, ways), tracer.blocked(points, ways)),
        (instances.occluded(points, ways), tracer.occluded(points, ways)),
    ):
        assert 0.001 < exact.mean() < 0.9
        assert np.mean(found != exact) < 0.003  # those that graze one, or end at it


def test_a_light_inside_an_objects_sphere_is_answered_as_by_embree(fields):
    """Between a torus's sides, over a box's face: nothing behind the light hides it."""
    kinds, placements = np.array([2, 1]), np.stack([np.eye(4), np.eye(4)])
    placements[1, :3, 3] = 0, 0, -2.5
    instances, tracer = FieldInstances(fields, kinds, placements), traced(kinds, placements)
    rng = np.random.default_rng(8)
    points = rng.uniform(-2, 2, (20_000, 3)).astype(np.float32)
    for light in ((0, 0, 0), (0.1, 0.2, 0.3), (0, 0.4, -2.5)):
        ways = np.float32(light) - points
        found, exact = instances.blocked(points, ways), tracer.blocked(points, ways)
        assert np.mean(found != exact) < 0.003 and 0.05 < exact.mean() < 0.9


def test_moved_copies_block_where_they_are(fields):
    """To the bit what they block when they are put there at first; the fields are not touched."""
    rng = np.random.default_rng(4)
    kinds = rng.integers(3, size=20)
    before, after = placed(kinds, rng), placed(kinds, rng)
    instances = FieldInstances(fields, kinds, before)
    points, ways = some_ways(5000, rng)
    was = instances.blocked(points, ways)
    instances.place(after)
    now = instances.blocked(points, ways)
    assert np.array_equal(now, FieldInstances(fields, kinds, after).blocked(points, ways))
    assert np.mean(now != was) > 0.05


def test_what_is_nearer_than_the_bias_hides_nothing(fields):
    """From inside a box of half a height of 0.15 its top is no farther than that."""
    instances = FieldInstances(fields, np.array([1]), np.eye(4)[None])
    up = np.float32([[0, 1, 0]])
    assert instances.occluded(0 * up, up, bias=0.13).all()
    assert not instances.occluded(0 * up, up, bias=0.17).any()
    assert not instances.blocked(0 * up, 2 * up, bias=0.085).any()


def test_copies_of_a_field_take_no_room_of_their_own(fields):
    few, many = (
        FieldInstances(fields, np.zeros(count, int), np.tile(np.eye(4), (count, 1, 1)))
        for count in (1, 1000)
    )
    assert (many.bytes - few.bytes) / 1000 < 128  # a transform, a box and a name

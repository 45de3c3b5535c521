"""Rays among copies of meshes, beside one tracer over all their triangles."""

import numpy as np
import pytest
import trimesh
from shapes import box, bumpy_sphere, prepared
from trimesh.transformations import random_rotation_matrix

from neural_shadows.scenes.forest import APART, SHIFT, SIZES, scattered
from neural_shadows.scenes.instance_tree import instance_tree
from neural_shadows.scenes.mesh_instances import MeshInstances
from neural_shadows.scenes.tracing import Tracer

SHAPES = [bumpy_sphere(3), box(0.9, 0.3, 1.3)]
RNG = np.random.default_rng(5)


@pytest.fixture(scope="module")
def forest() -> tuple[MeshInstances, Tracer]:
    kinds = RNG.integers(2, size=30)
    placements = np.stack([random_rotation_matrix(RNG.random(3)) for _ in kinds])
    placements[:, :3, :3] *= RNG.uniform(0.3, 0.8, (30, 1, 1))
    placements[:, :3, 3] = RNG.uniform(-3, 3, (30, 3))
    shapes = [SHAPES[kind].copy().apply_transform(one) for kind, one in zip(kinds, placements)]
    whole = trimesh.util.concatenate(shapes)
    meshes = [prepared(shape)[0] for shape in SHAPES]
    return MeshInstances(meshes, kinds, placements), prepared(whole)


def some_ways(count):
    points, goals = RNG.uniform(-4, 4, (2, count, 3))
    return points.astype(np.float32), (goals - points).astype(np.float32)


def test_rays_meet_what_they_meet_of_all_triangles(forest):
    instances, (mesh, tracer) = forest
    points, ways = some_ways(5000)
    t, n_g = instances.first_hit(points, ways)
    exact, face = tracer.first_hit(points, ways)
    same = np.isclose(t, exact, atol=1e-4)  # also ∞
    assert np.mean(~same) < 0.001 and 0.05 < np.isfinite(exact).mean() < 0.95
    hit = np.flatnonzero(same & (face >= 0))
    cosines = np.einsum("ij,ij->i", n_g[hit], mesh.face_normals[face[hit]])
    assert np.mean(cosines < 0.999) < 0.001
    for name in ("occluded", "blocked"):
        found, exact = getattr(instances, name)(points, ways), getattr(tracer, name)(points, ways)
        assert np.mean(found != exact) < 0.001 and 0.05 < exact.mean() < 0.95


def test_a_forest_stands_on_the_ground_and_apart():
    objects = [shape.vertices for shape in SHAPES]
    kinds, placements = scattered(objects, ["y", "z"], 50, np.random.default_rng(1))
    assert np.bincount(kinds).tolist() == [25, 25]
    stood = [objects[kind] @ one[:3, :3].T + one[:3, 3] for kind, one in zip(kinds, placements)]
    assert [one[:, 1].min() for one in stood] == pytest.approx([0.0] * 50, abs=1e-9)
    scales = np.cbrt(np.linalg.det(placements[:, :3, :3]))  # nothing is mirrored
    assert SIZES[0] <= scales.min() and scales.max() <= SIZES[1]
    places = placements[:, [0, 2], 3]
    away = np.linalg.norm(places[:, None] - places, axis=2) + 10 * np.eye(50)
    assert away.min() >= APART - 2 * SHIFT
    # The second lies along z: upright it is as high as it was long.
    heights = np.array([np.ptp(one[:, 1]) for one in stood]) / scales
    assert heights[kinds == 1] == pytest.approx(1.3, abs=0.15)


@pytest.mark.parametrize("count", [1, 2, 3, 8, 9, 100])
def test_a_tree_has_each_box_once_and_round_it_all_boxes_above(count):
    low = RNG.uniform(-5, 5, (count, 3))
    boxes = np.concatenate([low, low + RNG.uniform(0, 2, (count, 3))], axis=1).astype(np.float32)
    tree = instance_tree(boxes)
    seen = []

    def look(node, around):
        for child in np.flatnonzero(tree.boxes[node, 0] < np.inf):
            box = tree.boxes[node, :, child]
            assert (box[:3] >= around[:3]).all() and (box[3:] <= around[3:]).all()
            below = tree.children[node, child]
            if below >= 0:
                look(below, box)
            else:
                seen.append(-1 - below)
                assert np.array_equal(box, boxes[-1 - below])

    look(0, np.repeat(np.float32([-np.inf, np.inf]), 3))
    assert sorted(seen) == list(range(count))

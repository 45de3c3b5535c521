"""Edges and bodies of triangles, and equal rows, against trimesh and numpy."""

import numpy as np
import pytest
import trimesh

from neural_shadows.meshes.equal_rows import first_equal
from neural_shadows.meshes.sides import count_bodies, edges_by_uses, sides_by_edges


def meshes() -> dict[str, np.ndarray]:
    """Faces (F, 3): closed, with edges of all uses, and a fan of more sides than are inserted."""
    rng = np.random.default_rng(0)
    soup = rng.integers(0, 30, (150, 3))
    soup = soup[(soup != np.roll(soup, 1, axis=1)).all(axis=1)]
    rim = np.arange(1, 201)
    fan = np.stack([np.zeros_like(rim), rim, np.roll(rim, -1)], axis=1)
    apart = np.concatenate([trimesh.creation.box().faces + 8 * k for k in range(3)])
    ball = trimesh.creation.icosphere(2).faces
    return {
        "ball": ball,
        "soup": np.unique(soup, return_inverse=True)[1],
        "fan": fan,
        "apart": apart,
    }


@pytest.mark.parametrize("name", meshes())
def test_edges_and_bodies(name):
    faces = np.asarray(meshes()[name]).reshape(-1, 3)
    count = faces.max() + 1
    mesh = trimesh.Trimesh(np.zeros((count, 3)), faces, process=False)
    uses = np.bincount(mesh.edges_unique_inverse)
    expected = [(uses == 1).sum(), (uses == 2).sum(), (uses > 2).sum()]
    assert edges_by_uses(faces, count).tolist() == expected
    assert count_bodies(faces, count) == mesh.body_count


@pytest.mark.parametrize("name", meshes())
def test_sides_lie_by_their_edges(name):
    faces = np.asarray(meshes()[name]).reshape(-1, 3)
    firsts, sides, others = sides_by_edges(faces, faces.max() + 1)
    assert sorted(sides) == list(range(3 * len(faces)))
    lower = np.repeat(np.arange(len(firsts) - 1), np.diff(firsts))
    f, k = sides // 3, sides % 3
    ends = np.sort(np.stack([faces[f, k], faces[f, (k + 1) % 3]], axis=1), axis=1)
    assert np.array_equal(ends, np.stack([lower, others], axis=1))
    order = np.lexsort([f, k, others, lower])
    assert np.array_equal(order, np.arange(len(order)))


def test_equal_rows():
    rows = np.random.default_rng(1).integers(-3, 3, (500, 3)) * 10**7
    expected = [np.flatnonzero((rows == row).all(axis=1))[0] for row in rows]
    assert first_equal(rows).tolist() == expected
    assert len(first_equal(np.zeros((0, 3)))) == 0

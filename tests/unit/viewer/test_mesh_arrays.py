"""A mesh in few bytes is the same mesh, to a step of its grid."""

import base64
import zlib

import numpy as np
import pytest
import trimesh
from shapes import bumpy_sphere
from viewer_page import restored_mesh

from neural_shadows.viewer.mesh_arrays import BITS, mesh_arrays
from neural_shadows.viewer.packed import packed


def by_place(corners):
    """Triangles (F, 3, 3) in an order that does not depend on theirs."""
    turned = [np.roll(c, -np.lexsort(c.T[::-1])[0], axis=0) for c in np.round(corners, 6)]
    return np.array(sorted(map(np.ravel, turned), key=tuple))


SHAPES = {
    "closed": bumpy_sphere(3),
    "two pieces": trimesh.util.concatenate(
        trimesh.creation.box([0.3] * 3), trimesh.creation.box([1.0, 0.1, 0.2])
    ),
    "soup": trimesh.Trimesh(
        np.random.default_rng(0).uniform(-0.5, 0.5, (60, 3)),
        np.arange(60).reshape(-1, 3),
        process=False,
    ),
}


@pytest.mark.parametrize("name", SHAPES)
def test_same_triangles_to_a_step(name):
    shape, grid = SHAPES[name], 2**BITS - 1
    # Places on the grid come back as they are: so each triangle can be found again.
    vertices = (np.round((shape.vertices + 1) / 2 * grid) / grid * 2 - 1).astype(np.float32)
    found, faces = restored_mesh(mesh_arrays(vertices, shape.faces))
    assert len(found) == len(np.unique(shape.faces)) and len(faces) == len(shape.faces)
    assert np.allclose(by_place(found[faces]), by_place(vertices[shape.faces]), atol=2e-6)


def test_vertices_move_by_half_a_step_at_most():
    shape = bumpy_sphere(4)
    found, _ = restored_mesh(mesh_arrays(shape.vertices, shape.faces))
    # In an order of its own: by each axis apart.
    moved = np.abs(np.sort(found, axis=0) - np.sort(shape.vertices, axis=0))
    assert moved.max() <= 1.01 / (2**BITS - 1)


def test_a_triangle_takes_three_bytes():
    shape = bumpy_sphere(6)
    arrays = mesh_arrays(shape.vertices, shape.faces)
    letters = sum(len(packed(array)["data"]) for array in arrays)
    assert letters * 3 / 4 < 3.2 * len(shape.faces)


def test_packed_bytes_stand_in_planes():
    text = packed(np.array([[1, 258], [3, 65535]], np.uint16))
    assert text["kind"] == "uint16"
    planes = zlib.decompress(base64.b64decode(text["data"]))
    assert planes == bytes([1, 2, 3, 255, 0, 1, 0, 255])

"""Meshes whose every vertex and face counts once, in any unit."""

import numpy as np
import pytest
import trimesh
from mesh_files import TETRAHEDRON, TETRAHEDRON_FACES

from neural_shadows.errors import InputError
from neural_shadows.meshes.cleaning import clean_mesh, closedness


@pytest.mark.parametrize(
    ("vertices", "words"),
    [
        (np.where(TETRAHEDRON == 1, np.nan, 0), r"vertex 1 .*nan, 0\.0, 0\.0"),
        (np.ones((4, 3)), "diagonal 0"),
        ([[0, 0, 0], [1, 0, 0], [2, 1e-9, 0], [3, 0, 0]], "zero area"),  # lower than float32's 1
    ],
)
def test_refuses_what_is_no_surface(vertices, words):
    with pytest.raises(InputError, match=f"mesh thing: .*{words}"):
        clean_mesh(np.array(vertices), TETRAHEDRON_FACES, "thing")


@pytest.mark.parametrize(("unit", "offset"), [(1, 0), (1e-6, 0), (1, 1e6), (1e150, 0)])
def test_cleans_everything_at_once_in_any_unit(unit, offset):
    """A tetrahedron with a seam and every kind of bad face."""
    extra = [
        TETRAHEDRON[1],  # 4: a copy of 1
        TETRAHEDRON[2] + 1e-10,  # 5: near 2, far below 1e-8 of the diagonal (1.7)
        [0.5, 0, 0],  # 6: on the edge 0-1
        [9, 9, 9],  # 7: of no face
        TETRAHEDRON[3] + 1e-6,  # 8: near 3 but not the same
    ]
    faces = [
        [0, 2, 1],
        [0, 4, 3],
        [0, 3, 5],
        [4, 5, 3],
        [1, 3, 0],  # a duplicate of 1
        [2, 0, 1],  # a duplicate of 0
        [3, 2, 1],  # 3 with the opposite winding
        [0, 0, 1],  # an index twice
        [1, 4, 3],  # twice after merging
        [0, 6, 1],  # collinear
    ]
    vertices = np.vstack([TETRAHEDRON, extra]) * unit + offset
    cleaned, faces, report = clean_mesh(vertices, np.array(faces), "thing")
    np.testing.assert_array_equal(cleaned, TETRAHEDRON * unit + offset)
    np.testing.assert_array_equal(faces, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    assert report == {
        "source_vertices": 9,
        "source_faces": 10,
        "vertices": 4,
        "faces": 4,
        "merged_vertices": 2,
        "unreferenced_vertices": 3,  # 7 and 8, and 6 once its face is gone
        "degenerate_faces": 3,
        "duplicate_faces": 3,
    }


def test_keeps_what_is_small_but_real():
    # One corner cut off at 1e-6 of the size.
    vertices = np.vstack([TETRAHEDRON, [[0, 0, 1 - 1e-6]]])
    faces = [[0, 2, 1], [0, 1, 4], [0, 4, 2], [1, 2, 3], [1, 3, 4], [2, 4, 3]]
    _, _, report = clean_mesh(vertices, np.array(faces), "thing")
    assert (report["vertices"], report["faces"]) == (5, 6)


def test_how_closed_a_mesh_is():
    box = trimesh.creation.box().faces
    names = ("watertight", "open_edges", "non_manifold_edges", "bodies")
    for faces, expected in (
        (box, (True, 0, 0, 1)),
        (np.vstack([box, box + 8])[1:], (False, 3, 0, 2)),
        ([[0, 1, 2], [0, 1, 3], [0, 1, 4]], (False, 6, 1, 1)),  # three sheets share an edge
    ):
        assert closedness(np.array(faces)) == dict(zip(names, expected))

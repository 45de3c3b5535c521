"""Sheets are told from solids, with holes or without."""

import numpy as np
import pytest
import trimesh

from neural_shadows.meshes.landscape import make_landscape
from neural_shadows.meshes.open_sides import is_sheet

BALL = trimesh.creation.icosphere(4)
BOX = trimesh.creation.box(extents=[1, 1, 1])
TUBE = trimesh.creation.cylinder(0.15, 1, sections=64)


def above(height):
    return BALL.vertices, BALL.faces[BALL.triangles_center[:, 2] > height]


@pytest.mark.parametrize(
    ("vertices", "faces", "expected"),
    [
        (*make_landscape(cells=64), True),
        (*above(0), True),
        (BOX.vertices, BOX.faces[BOX.face_normals[:, 2] < 0.5], True),  # no lid
        (TUBE.vertices, TUBE.faces[np.abs(TUBE.face_normals[:, 2]) < 0.5], True),
        (BALL.vertices, BALL.faces, False),
        (*above(-0.95), False),  # a scan with a hole
        (
            np.vstack([BOX.vertices, BOX.vertices + 0.2]),
            np.vstack([BOX.faces, BOX.faces + 8]),
            False,
        ),
    ],
)
def test_sheets(vertices, faces, expected):
    mixed = faces.copy()
    mixed[::2] = mixed[::2, ::-1]
    for wound in (faces, faces[:, ::-1], mixed):
        assert is_sheet(vertices, wound) == expected

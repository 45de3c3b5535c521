"""Where a pixel shows two surfaces: the rim of a sheet, the crease of a box, and nowhere else."""

import numpy as np
import trimesh
from shapes import Y_UP, scene_of, sheet

from neural_shadows.rendering.geometry_edges import geometry_edges
from neural_shadows.rendering.soft_shadows import CENTRE, PLACES, see_places
from neural_shadows.scenes.cameras import Camera


def edges_of(mesh, eye, target=(0.0, 0.0, 0.0)):
    """Edges in 64 × 32 pixels."""
    scene = scene_of(mesh, ground=False, light=None)
    camera = Camera(np.array(eye), np.array(target), Y_UP, 40.0)
    return geometry_edges(see_places(scene, camera, 64, 32, (CENTRE, *PLACES)))


def test_a_plane_has_no_edges_however_slanted():
    for eye in ([0, 5.0, 0.1], [0, 1.0, 8.0]):
        ground = sheet(0.0, 200.0)
        edges = edges_of(ground, eye, (0.0, 0.0, -0.1))
        assert not edges[11:].any()  # below the horizon


def test_a_crease_between_two_planes():
    """A box from in front of one of its vertical edges: that edge is in the middle of the image."""
    edges = edges_of(trimesh.creation.box([2, 4, 2]), [4.0, 0.0, 4.3])
    assert edges[8:24, 31:33].any(axis=1).all()
    assert edges[:, 24:30].sum() == edges[:, 34:40].sum() == 0


def test_a_sheet_before_another():
    """The nearer one's rim, in one column of pixels or two."""
    near = sheet(1.0, 20.0)
    near.apply_translation([20.04, 0, 0])
    edges = edges_of(trimesh.util.concatenate([sheet(0.0, 200.0), near]), [0.0, 6.0, 0.05])
    columns = np.flatnonzero(edges.all(axis=0))
    assert 1 <= len(columns) <= 2 and edges.sum() <= 2 * 32

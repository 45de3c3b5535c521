"""The stand-in dragon's mesh against what is asked of it."""

import numpy as np
import pytest
import trimesh

from neural_shadows.meshes.wyrm import make_wyrm


@pytest.fixture(scope="module")
def wyrm():
    return trimesh.Trimesh(*make_wyrm(), process=False)


def test_is_closed_outward_and_one_piece_in_single_precision(wyrm):
    """PLY files hold float32: no two vertices may fall together there."""
    rounded = trimesh.Trimesh(wyrm.vertices.astype(np.float32), wyrm.faces, process=True)
    assert rounded.is_watertight and rounded.is_winding_consistent and rounded.volume > 0.1
    assert rounded.body_count == 1 and len(rounded.vertices) == len(wyrm.vertices)
    assert rounded.nondegenerate_faces().all()


def test_the_same_bytes_of_the_promised_size(wyrm):
    assert 230_000 <= len(wyrm.faces) <= 250_000
    assert [a.tobytes() for a in make_wyrm(64)] == [a.tobytes() for a in make_wyrm(64)]


def test_every_foot_stands_on_the_ground(wyrm):
    assert wyrm.bounds[0, 1] == 0
    for x, z in [(-0.33, 0.24), (-0.21, -0.24), (0.39, 0.23), (0.23, -0.23)]:
        under = np.hypot(wyrm.vertices[:, 0] - x, wyrm.vertices[:, 2] - z) < 0.2
        assert wyrm.vertices[under, 1].min() < 0.01 * wyrm.scale

"""Height maps: exact depths, and refusal of other meshes."""

import numpy as np
import pytest
import torch
import trimesh
from built_networks import laid_out, reloaded
from rays import ball_rays
from shapes import box, prepared, sheet

from neural_shadows.errors import InputError
from neural_shadows.meshes.landscape import make_landscape
from neural_shadows.representations.depths import LIT


def build_network(shape: trimesh.Trimesh, tmp_path, resolution: int, bits: int = 16, up: str = "y"):
    settings = {"encoding": "height_map", "up": up, "resolution": resolution, "bits": bits}
    return reloaded(laid_out(shape, tmp_path, settings), tmp_path, settings)


def trace(network, o: np.ndarray, d: np.ndarray) -> np.ndarray:
    return network(torch.from_numpy(o), torch.from_numpy(d), torch.float32).numpy()


def traced(shape: trimesh.Trimesh, o: np.ndarray, d: np.ndarray) -> np.ndarray:
    t, _ = prepared(shape)[1].first_hit(o, d)
    return np.where(np.isfinite(t), t, LIT)


@pytest.mark.parametrize("up", ["x", "y", "z"])
def test_it_is_exact_on_a_tilted_plane(tmp_path, up):
    corners = [[-0.6, -0.1, -0.5], [-0.6, 0.2, 0.5], [0.6, 0.4, 0.5], [0.6, 0.1, -0.5]]
    corners = np.roll(corners, "xyz".index(up) - 1, axis=1)
    shape = trimesh.Trimesh(corners, [[0, 1, 2], [0, 2, 3]], process=False)
    o, d = ball_rays(5000)[:2]
    expected = traced(shape, o, d)
    t = trace(build_network(shape, tmp_path, 9, up=up), o, d)
    assert 0.1 < (expected < LIT).mean() < 0.9
    # 16 bits of a height of 0.5 are 8e-6, and a ray may graze; or pass the rim on either side.
    assert (np.abs(t - expected) < 1e-4).mean() > 0.998


def test_a_level_plane_has_no_heights(tmp_path):
    o = np.array([[0, 1, 0], [0.8, 0.6, 0]], np.float32)
    d = np.array([[0, -1, 0], [-0.8, -0.6, 0]], np.float32)
    t = trace(build_network(sheet(0.25, 0.5), tmp_path, 3), o, d)
    np.testing.assert_allclose(t, [0.75, 0.35 / 0.6], atol=1e-6)


@pytest.mark.parametrize(("bits", "close"), [(16, 1e-4), (8, 0.02)])
def test_a_landscape_of_as_many_vertices_is_exact_but_for_rounding(tmp_path, bits, close):
    vertices, faces = make_landscape(cells=32)
    shape = trimesh.Trimesh(vertices * 0.65, faces, process=False)
    o, d = ball_rays(8000)[:2]
    expected = traced(shape, o, d)
    t = trace(build_network(shape, tmp_path, 33, bits), o, d)
    assert 0.3 < (expected < LIT).mean() < 0.99
    assert (np.abs(t - expected) < close).mean() > 0.99


def without(shape: trimesh.Trimesh, faces: np.ndarray) -> trimesh.Trimesh:
    return trimesh.Trimesh(shape.vertices, shape.faces[~faces], process=False)


@pytest.mark.parametrize(
    ("shape", "up"),
    [
        (trimesh.creation.icosphere(2), "y"),
        (without(box(1, 1, 1), box(1, 1, 1).face_normals[:, 1] > 0.5), "y"),  # walls round a floor
        (without(sheet(0.1, 0.5), np.array([True, False])), "y"),
        (sheet(0.1, 0.5), "x"),
    ],
)
def test_other_meshes_are_refused(tmp_path, shape, up):
    with pytest.raises(InputError, match=f"no height field along {up}: .*Give another `up`"):
        build_network(shape, tmp_path, 9, up=up)

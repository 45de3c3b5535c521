"""Voxel DAGs against a dense march, a sphere and the octree."""

import numpy as np
import pytest
import torch
import trimesh
from built_networks import laid_out, reloaded
from rays import ball_batch, ball_rays
from shapes import bumpy_sphere

from neural_shadows.networks.object_space.shadow_network import hits
from neural_shadows.representations.depths import LIT
from neural_shadows.representations.voxels.occupancy import enclosed_cells, surface_cells
from neural_shadows.representations.voxels.voxel_bricks import surface_bricks
from neural_shadows.representations.voxels.voxel_dag import merged, octree, words_of
from neural_shadows.representations.voxels.voxel_inside import inside_of


def build_network(shape: trimesh.Trimesh, tmp_path, resolution: int, surface: str):
    settings = {"encoding": "voxel_dag", "resolution": resolution, "surface": surface}
    return reloaded(laid_out(shape, tmp_path, settings), tmp_path, settings)


def holed_sphere() -> trimesh.Trimesh:
    """A bumpy sphere that lacks a face of a voxel's size, which does not open it."""
    shape = bumpy_sphere(4)
    return trimesh.Trimesh(shape.vertices, shape.faces[1:], process=False)


def march(cells: np.ndarray, o: np.ndarray, d: np.ndarray) -> np.ndarray:
    """Where rays enter their first cell, by every border that they cross, in float64."""
    n = len(cells)
    borders = np.linspace(-1, 1, n + 1)
    entries = np.full(len(o), LIT)
    for i, (start, direction) in enumerate(zip(o.astype(float), d.astype(float))):
        end = -2 * start @ direction
        t = np.concatenate([(borders - start[k]) / direction[k] for k in range(3) if direction[k]])
        t = np.sort(np.append(t[(t > 0) & (t < end)], [0, end]))
        middles = start + (t[:-1] + t[1:])[:, None] / 2 * direction
        x, y, z = np.clip((middles + 1) / 2 * n, 0, n - 1).astype(int).T
        met = np.flatnonzero(cells[x, y, z])
        if len(met):
            entries[i] = t[met[0]]
    return entries


@pytest.mark.parametrize("surface", ["solid", "sheet"])
def test_rays_end_in_the_first_voxel_of_a_dense_march(tmp_path, surface):
    shape = holed_sphere()
    network = build_network(shape, tmp_path, 32, surface)
    cells = surface_cells(shape.vertices, shape.faces, 32)
    if surface == "solid":
        cells = enclosed_cells(cells)
    o, d = ball_rays(2000)[:2]
    d[:300, 0] = 0  # along planes of the grid, and some along an axis
    d[:100, 1] = 0
    d[:300] /= np.linalg.norm(d[:300], axis=1, keepdims=True)
    inward = (o * d).sum(1) < 0
    o, d = o[inward], d[inward]
    t = network(torch.from_numpy(o), torch.from_numpy(d), torch.float32).numpy()
    expected = march(cells, o, d)
    assert 0.3 < (expected < LIT).mean() < 1
    # A ray along an edge of voxels may be counted to either side.
    assert (np.abs(t - expected) < 1e-5).mean() > 0.999


@pytest.mark.parametrize(("surface", "nearest", "farthest"), [("solid", -1, 0), ("sheet", 0, 1)])
def test_rays_end_within_a_voxel_of_a_balls_surface(tmp_path, surface, nearest, farthest):
    network = build_network(trimesh.creation.icosphere(6, radius=0.5), tmp_path, 128, surface)
    batch = ball_batch(3000)
    o, d, t_lb, t_ub = batch
    t = network(o, d, torch.float32)
    assert (t[hits(batch) & (t_ub - t_lb > 0.4)] < LIT).all()
    ends = (o + t[:, None] * d)[t < LIT]
    diagonal = 3**0.5 * 2 / 128
    above = (ends.norm(dim=1) - 0.5) / diagonal
    # The faces are up to 1e-4 inside the ball.
    assert nearest - 0.02 < above.min() < above.max() < farthest + 0.02
    assert above.max() - above.min() > 0.7


def test_an_open_shell_has_no_inside(tmp_path):
    shape = bumpy_sphere(3)
    shell = trimesh.Trimesh(shape.vertices, shape.faces[: len(shape.faces) // 2], process=False)
    network = build_network(shell, tmp_path, 64, "solid")
    assert network.resident_bytes() == 4
    assert (network(*ball_batch(100)[:2], torch.float32) == LIT).all()


def test_offsets_beyond_the_words_are_refused(tmp_path):
    network = build_network(bumpy_sphere(3), tmp_path, 64, "solid")
    words = network.stored()["words"]
    assert len(words) > 100
    index = int((words[:40] > 255).nonzero()[0])
    for bad in (len(words), len(words) - 1, -1):
        changed = words.clone()
        changed[index] = bad
        with pytest.raises(ValueError, match=f"a node beyond its {len(words)} words"):
            network.restore({"words": changed})
    for bad in (words[:-1], words[:1], words[:0]):
        with pytest.raises(ValueError, match="a node beyond its"):
            network.restore({"words": bad})
    with pytest.raises(ValueError, match="float32 words"):
        network.restore({"words": words.float()})
    network.restore({"words": words})


def test_equal_parts_are_stored_once():
    shape = bumpy_sphere(4)
    tree = octree(surface_bricks(shape.vertices, shape.faces, 8), 8)
    for voxels in (tree, inside_of(tree)):
        dag = merged(voxels)
        assert words_of(dag).nbytes < 0.9 * words_of(voxels).nbytes
        for level in (*dag.levels, dag.bricks[:, None]):
            assert len(np.unique(level, axis=0)) == len(level)

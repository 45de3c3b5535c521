"""Ray grids: interpolation, sample points, training."""

import pytest
import torch
import trimesh
from built_networks import make_network, reloaded
from rays import ball_batch
from shapes import bumpy_sphere, prepared

from neural_shadows.networks.object_space.dead_zone_loss import DeadZone
from neural_shadows.networks.object_space.ray_grid_network import FeatureGrid
from neural_shadows.networks.object_space.shadow_network import LabelledBatch, chords, hits
from neural_shadows.rays.labels import dual_bounds

SMALL = {
    "points": 4,
    "grids": [6, 12],
    "channels": 3,
    "width": 32,
    "hidden_layers": 2,
    "head": "depth",
    "stored": "float32",
}
KINDS = {
    "ray_grid": SMALL | {"encoding": "ray_grid"},
    "occupancy_ray_grid": SMALL | {"encoding": "occupancy_ray_grid", "occupancy": 16},
    "hash_grid": SMALL | {"encoding": "hash_grid", "occupancy": 16, "table_size": 512},
}


@pytest.fixture(scope="module")
def ball_ply(tmp_path_factory):
    path = tmp_path_factory.mktemp("ball") / "mesh.ply"
    trimesh.creation.icosphere(4, radius=0.5).export(path)
    return path


def build_network(kind: str, mesh_ply, **changes):
    network = make_network(KINDS[kind] | changes)
    if kind != "ray_grid":
        network.prepare(mesh_ply)
    network.initialise(1)
    return network


def test_a_grid_interpolates_linear_functions_exactly():
    grid = FeatureGrid(7, 2)
    axis = torch.linspace(-1, 1, 7)
    x, y, z = torch.meshgrid(axis, axis, axis, indexing="ij")
    values = torch.stack([x + 2 * y - 3 * z, 1 - x], dim=-1)
    grid.values.data = values.reshape(-1, 2)
    p = torch.rand(500, 3, generator=torch.Generator().manual_seed(0)) * 2 - 1
    expected = torch.stack([p @ torch.tensor([1.0, 2, -3]), 1 - p[:, 0]], dim=1)
    assert torch.allclose(grid(p), expected, atol=1e-5)
    # The cube's corners are vertices, and what is outside is clamped to it.
    assert torch.allclose(grid(torch.tensor([[2.0, 1, 1]])), torch.tensor([[0.0, 0]]), atol=1e-6)


def test_points_lie_around_every_hit(tmp_path):
    shape = bumpy_sphere(4)
    shape.export(tmp_path / "mesh.ply")
    network = build_network("occupancy_ray_grid", tmp_path / "mesh.ply", occupancy=48)
    _, tracer = prepared(shape)
    o, d, *_ = ball_batch(20_000)
    t_lb, t_ub = map(torch.from_numpy, dual_bounds(tracer, o.numpy(), d.numpy()))
    t_a, t_b, meets = network.span(o, d)
    hit = hits(LabelledBatch(o, d, t_lb, t_ub))
    assert 0.2 < hit.float().mean() < 0.95
    assert meets[hit].all() and meets[~hit].float().mean() < 0.95
    before, behind = (t_lb - t_a)[hit], (t_b - t_lb)[hit]
    assert (before > -1e-4).float().mean() > 0.99 and (behind > -1e-4).float().mean() > 0.99
    # Of a corner that is cut between two steps, a step of half a cell is lost.
    assert before.min() > -1 / 48 and behind.min() > -1 / 48
    assert (t_a >= 0).all() and (t_b <= chords(o, d) + 1e-6).all()
    # Where nothing is, they take up less of the ray than the whole.
    assert ((t_b - t_a)[meets] / chords(o, d)[meets]).mean() < 0.95


@pytest.mark.parametrize(("kind", "head"), [*zip(KINDS, ("depth", "depth_confidence", "depth"))])
def test_it_learns_a_ball(ball_ply, kind, head):
    """Half of the rays hit; a lit point in front and a shadowed one behind tell right from wrong."""
    network = build_network(kind, ball_ply, head=head)
    batch = ball_batch(4096)
    optimiser = torch.optim.Adam(network.parameters(), lr=5e-3)
    for _ in range(150):
        losses, _ = network.losses(batch, DeadZone(), torch.float32, None)
        optimiser.zero_grad()
        (losses.sum() / 4096).backward()
        optimiser.step()
    batch = ball_batch(4096, seed=5)
    o, d, t_lb, _ = batch
    with torch.inference_mode():
        t = network(o, d, torch.float32)
    hit = hits(batch)
    lit_in_front = t_lb - 0.05 <= t
    lit_behind = chords(o, d) <= t + 0.02
    assert lit_in_front.float().mean() > 0.97
    assert lit_behind[~hit].float().mean() > 0.9
    assert (~lit_behind[hit]).float().mean() > 0.9


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(("stored", "error"), [("float32", 0), ("float16", 2e-3), ("int8", 0.1)])
def test_round_trip_of_weight_files(tmp_path, ball_ply, kind, stored, error):
    settings = KINDS[kind] | {"stored": stored}
    network = build_network(kind, ball_ply, stored=stored)
    loaded = reloaded(network, tmp_path, settings)
    o, d, *_ = ball_batch(500)
    with torch.inference_mode():
        expected, result = (net(o, d, torch.float32) for net in (network, loaded))
    assert (result - expected).abs().max() <= error
    # As the answers of a file are those of the network it makes, writing it again is the same.
    again = reloaded(loaded, tmp_path, settings)
    assert torch.equal(again(o, d, torch.float32), result)

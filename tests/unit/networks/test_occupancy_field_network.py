"""Occupancy fields: what they interpolate, where rays cross them, and that they learn surfaces."""

import numpy as np
import pytest
import torch
import trimesh
from rays import ball_batch, ball_rays
from shapes import bumpy_sphere, prepared, sheet

from neural_shadows.networks.kinds import make_network
from neural_shadows.networks.object_space.dead_zone_loss import DeadZone
from neural_shadows.networks.object_space.occupancy_field_network import LIMIT
from neural_shadows.networks.object_space.shadow_network import LIT, LabelledBatch, chords, hits
from neural_shadows.networks.weight_file import load_network, save_network
from neural_shadows.rays.labels import dual_bounds

SOLID_32 = {"encoding": "occupancy_field", "resolution": 32, "surface": "solid", "stored": "int8"}
SHEET_32 = SOLID_32 | {"surface": "sheet"}


def made(shape: trimesh.Trimesh, tmp_path, settings):
    shape.export(tmp_path / "mesh.ply")
    network = make_network(settings)
    network.prepare(tmp_path / "mesh.ply")
    network.initialise(1)
    return network


def positions(network) -> torch.Tensor:
    """Where the network's values are, (count, 3)."""
    size = network.resolution // 4
    cells = np.argwhere(network.grid.view(size, size, size).numpy() >= 0)
    corners = np.stack(np.unravel_index(np.arange(125), (5, 5, 5)), axis=1)
    places = (4 * cells[:, None] + corners).reshape(-1, 3) / (network.resolution / 2) - 1
    found = np.full((len(network.values), 3), np.nan)
    found[network.table.numpy()] = places
    return torch.from_numpy(found).float()


def set_logits(network, function) -> None:
    """Make the logits those of a function of positions (n, 3), within the limit."""
    with torch.no_grad():
        shares = (function(positions(network)) / LIMIT).clamp(-0.99, 0.99)
        network.values.copy_(LIMIT * shares.atanh())


def ball(p):
    return 40 * (0.5 - p.norm(dim=1))


@pytest.mark.parametrize("settings", [SOLID_32, SHEET_32])
def test_rays_cross_a_ball_where_it_is(tmp_path, settings):
    network = made(trimesh.creation.icosphere(4, radius=0.5), tmp_path, settings)
    set_logits(network, ball)
    batch = ball_batch(3000)
    o, d, t_lb, t_ub = batch
    with torch.inference_mode():
        t = network(o, d, torch.float32)
    hit = hits(batch)
    # Not where a ray only grazes the ball: the field's own surface is off by 1e-3 there.
    through = hit & (t_ub - t_lb > 0.2)
    assert (t - t_lb)[through].abs().max() < 0.01
    missed = ~hit & ((o - (o * d).sum(1, keepdim=True) * d).norm(dim=1) > 0.51)
    assert (t[missed] == LIT).all()


@pytest.mark.parametrize("settings", [SOLID_32, SHEET_32])
@pytest.mark.parametrize("stored", ["int8", "float32"])
def test_skipping_what_is_empty_changes_no_answer(tmp_path, settings, stored):
    """The CPU's march against the form that looks at every sample, on random logits."""
    settings = settings | {"stored": stored}
    network = made(bumpy_sphere(4), tmp_path, settings)
    set_logits(network, lambda p: 6 * torch.sin(40 * p).prod(1) + 20 * (0.85 - p.norm(dim=1)))
    save_network(tmp_path / "weights.safetensors", network, {"network": settings})
    network, _ = load_network(tmp_path / "weights.safetensors")
    rng = np.random.default_rng(0)
    for d in (*rng.normal(size=(6, 3)), [0, 0, 1], [0, -1, 0], [1, 1e-7, 0]):
        d = torch.tensor(d / np.linalg.norm(d), dtype=torch.float32)
        o = torch.from_numpy(rng.normal(size=(700, 3))).float()
        o /= o.norm(dim=1, keepdim=True)
        o = o[o @ d < -0.01]
        found = network.depths(o, d, torch.float32)
        with torch.inference_mode():
            expected = network(o, d.expand(len(o), 3), None)
        # A sample on a brick's border may be counted to either side.
        same = (found - expected).abs() < 1e-4
        assert same.float().mean() > 0.99
        assert (found < -2 * o @ d - 1e-3).float().mean() > 0.3


def learn(network, batch: LabelledBatch, steps: int) -> None:
    generator = torch.Generator().manual_seed(0)
    optimiser = torch.optim.Adam(network.parameters(), lr=0.5)
    for _ in range(steps):
        losses, _ = network.losses(batch, DeadZone(), torch.float32, generator)
        optimiser.zero_grad()
        losses.mean().backward()
        optimiser.step()


def test_it_learns_a_ball(tmp_path):
    network = made(trimesh.creation.icosphere(4, radius=0.5), tmp_path, SOLID_32)
    learn(network, ball_batch(30_000), 60)
    batch = ball_batch(2000, seed=3)
    o, d, t_lb, t_ub = batch
    with torch.inference_mode():
        t = network(o, d, torch.float32)
    wrong = torch.where(hits(batch), (t < t_lb - 0.02) | (t > t_ub), t < chords(o, d) - 1e-3)
    assert wrong.float().mean() < 0.01


@pytest.mark.parametrize("winding", [1, -1])
def test_a_sheet_is_learned_from_both_sides(tmp_path, winding):
    shape = sheet(0.1, 0.6, winding)
    network = made(shape, tmp_path, SHEET_32)
    _, tracer = prepared(shape)
    o, d = ball_rays(20_000)[:2]
    batch = LabelledBatch(*map(torch.from_numpy, (o, d, *dual_bounds(tracer, o, d))))
    learn(network, batch, 60)
    o, d, t_lb, _ = batch = LabelledBatch(*(part[:3000] for part in batch))
    hit = hits(batch)
    with torch.inference_mode():
        t = network(o, d, None)
    # Around its border a sheet's shadow reaches to its bricks' end: there the signs of both
    # sides meet without a surface between them.
    at = o + ((0.1 - o[:, 1]) / d[:, 1])[:, None] * d
    past = ~hit & (at[:, [0, 2]].abs().amax(1) > 0.6 + 2 * 0.25)
    for side in (d[:, 1] > 0.3, d[:, 1] < -0.3):
        near = (t - t_lb).abs() < 0.02
        assert near[hit & side].float().mean() > 0.95
        assert (past & side).sum() > 20 and (t[past & side] == LIT).all()

"""Occupancy fields: interpolation, crossings, training."""

import numpy as np
import pytest
import torch
import trimesh
from built_networks import laid_out, reloaded
from rays import ball_batch, ball_rays
from shapes import bumpy_sphere, prepared, sheet

from neural_shadows.networks.object_space.dead_zone_loss import DeadZone
from neural_shadows.networks.object_space.occupancy_field_network import LIMIT, PUSHES
from neural_shadows.networks.object_space.shadow_network import (
    LabelledBatch,
    ShadowNetwork,
    chords,
    hits,
)
from neural_shadows.networks.weight_file import load_network, save_network
from neural_shadows.rays.labels import dual_bounds
from neural_shadows.representations.depths import LIT
from neural_shadows.representations.distance_bricks.brick_layout import lay_out

SOLID_32 = {"encoding": "occupancy_field", "resolution": 32, "surface": "solid", "stored": "int8"}
SHEET_32 = SOLID_32 | {"surface": "sheet"}


def positions(network) -> torch.Tensor:
    """Where the network's values are, (count, 3)."""
    size = network.resolution // 4
    layout = lay_out(network.grid.view(size, size, size).numpy() >= 0, False)
    return torch.from_numpy(layout.vertices / (network.resolution / 2) - 1).float()


def set_logits(network, function) -> None:
    """Make the logits those of a function of positions (n, 3), within the limit."""
    with torch.no_grad():
        shares = (function(positions(network)) / LIMIT).clamp(-0.99, 0.99)
        network.values.copy_(LIMIT * shares.atanh())


def ball(p):
    return 40 * (0.5 - p.norm(dim=1))


@pytest.mark.parametrize("settings", [SOLID_32, SHEET_32])
def test_crossings_of_a_ball(tmp_path, settings):
    network = laid_out(trimesh.creation.icosphere(4, radius=0.5), tmp_path, settings)
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
@pytest.mark.parametrize(
    ("stored", "push"), [("int8", 0), ("float32", 0.1), ("coded", 0), ("sign", -0.1)]
)
def test_skipping_empty_space_changes_no_depth(tmp_path, settings, stored, push):
    """The CPU's march against the form that looks at every sample, on random logits."""
    settings = settings | {"stored": stored}
    network = laid_out(bumpy_sphere(4), tmp_path, settings)
    set_logits(network, lambda p: 6 * torch.sin(40 * p).prod(1) + 20 * (0.85 - p.norm(dim=1)))
    network = reloaded(network, tmp_path, settings)
    network.push = push
    rng = np.random.default_rng(0)
    for d in (*rng.normal(size=(6, 3)), [0, 0, 1], [0, -1, 0], [1, 1e-7, 0]):
        d = torch.tensor(d / np.linalg.norm(d), dtype=torch.float32)
        o = torch.from_numpy(rng.normal(size=(700, 3))).float()
        o /= o.norm(dim=1, keepdim=True)
        o = o[o @ d < -0.01]
        result = network.depths(o, d, torch.float32)
        with torch.inference_mode():
            expected = network(o, d.expand(len(o), 3), None)
        # A sample on a brick's border may be counted to either side.
        same = (result - expected).abs() < 1e-4
        assert same.float().mean() > 0.99
        assert (result < -2 * o @ d - 1e-3).float().mean() > 0.3


def learn(network, batch: LabelledBatch, steps: int) -> None:
    generator = torch.Generator().manual_seed(0)
    optimiser = torch.optim.Adam(network.parameters(), lr=0.5)
    for _ in range(steps):
        losses, _ = network.losses(batch, DeadZone(), torch.float32, generator)
        optimiser.zero_grad()
        losses.mean().backward()
        optimiser.step()


def test_it_learns_a_ball(tmp_path):
    network = laid_out(trimesh.creation.icosphere(4, radius=0.5), tmp_path, SOLID_32)
    learn(network, ball_batch(15_000), 60)
    batch = ball_batch(2000, seed=3)
    o, d, t_lb, t_ub = batch
    with torch.inference_mode():
        t = network(o, d, torch.float32)
    wrong = torch.where(hits(batch), (t < t_lb - 0.02) | (t > t_ub), t < chords(o, d) - 1e-3)
    assert wrong.float().mean() < 0.01


@pytest.mark.parametrize("winding", [1, -1])
def test_a_sheet_is_learned_from_both_sides(tmp_path, winding):
    shape = sheet(0.1, 0.6, winding)
    network = laid_out(shape, tmp_path, SHEET_32)
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


@pytest.mark.parametrize("resolution", [32, 64])
@pytest.mark.parametrize("stored", ["int8", "float32", "sign"])
def test_untrained_distances_of_a_ball_and_their_push(tmp_path, resolution, stored):
    """Rays through the centre end where the ball of a radius of 0.5 and so many cells does."""
    settings = SOLID_32 | {"resolution": resolution, "stored": stored, "start": "distances"}
    network = laid_out(trimesh.creation.icosphere(5, radius=0.5), tmp_path, settings)
    network = reloaded(network, tmp_path, settings)
    o = torch.nn.functional.normalize(ball_batch(1000)[0], dim=1)
    assert 0.0 in network.pushes and min(network.pushes) < 0 < max(network.pushes)
    for push in network.pushes:
        network.push = push
        with torch.inference_mode():
            t = network(o, -o, torch.float32)
        cells = (0.5 - t) * resolution / 2 - push
        if stored == "sign":
            assert cells.abs().max() < 1 and abs(cells.mean()) < 0.15
        else:
            # What interpolation cuts off a ball of r cells: x (1 − x) / 2 of the second
            # derivative, 1 / r on two axes; its mean is 1 / (6 r).
            assert cells.mean() == pytest.approx(-1 / (6 * resolution / 4), abs=0.005)
            assert cells.std() < 0.02


def test_a_trained_surface_is_not_pushed(tmp_path):
    settings = SOLID_32 | {"start": "distances"}
    network = laid_out(bumpy_sphere(3), tmp_path, settings)
    path = tmp_path / "weights.safetensors"
    for training, pushes in [(None, PUSHES), ({"steps": 60}, (0.0,))]:
        save_network(path, network, {"network": settings, "training": training})
        assert load_network(path)[0].pushes == pushes


def test_signs_take_a_bit_each(tmp_path):
    settings = SOLID_32 | {"stored": "sign", "start": "distances"}
    network = laid_out(bumpy_sphere(3), tmp_path, settings)
    values = network.stored()["values"]
    assert values.dtype == torch.uint8 and len(values) == -(-len(network.values) // 8)
    inside = positions(network).norm(dim=1) < 0.7
    assert (network.logits()[inside] > 0).all()


def test_a_query_on_a_cpu_holds_the_bricks(tmp_path):
    """Masks, words of the cells that are crossed, their places and a light's tables."""
    shape = trimesh.creation.icosphere(3, radius=0.5)
    resident = {}
    for bits in (4, 8):
        network = laid_out(shape, tmp_path, SOLID_32 | {"start": "distances", "corner_bits": bits})
        resident[bits] = network.resident_bytes()
    bricks = int((network.grid >= 0).sum())
    inside = (network.logits() > 0)[network.table.long()].view(-1, 5, 5, 5)
    cells = inside.unfold(1, 2, 1).unfold(2, 2, 1).unfold(3, 2, 1).flatten(4)
    crossed = cells.any(4) & ~cells.all(4)
    assert resident[8] - resident[4] == 4 * crossed.sum()
    # Bricks that the mesh touches and the field does not cross are not held.
    rows = int(crossed.flatten(1).any(1).sum()) + 4
    assert 0.7 * bricks < rows <= bricks + 4
    held = 4 * crossed.sum() + 20 * rows
    # The box of 8 bricks and 2 around them is 3 nodes a side.
    placed = 24 + 4 * 3**3 + 2 * 64 * (3**3 + 1)
    # A tile for each cell of 8 × 8 bricks and those beside it as seen aslant, and its row.
    tables = 12 * (2 * 32 + 3) ** 2 + 8 * (2 * 48 + 4)
    assert held + 12 * 16**2 < resident[4] < held + placed + tables


@pytest.mark.parametrize("settings", [SOLID_32, SHEET_32])
def test_points_are_lit_up_to_the_crossing(tmp_path, settings):
    """Whether anything is met, for any depth bias, against where it is met first."""
    network = laid_out(bumpy_sphere(4), tmp_path, settings)
    set_logits(network, lambda p: 6 * torch.sin(20 * p).prod(1) + 20 * (0.85 - p.norm(dim=1)))
    light = torch.nn.functional.normalize(torch.tensor([0.3, -0.5, 0.8]), dim=0)
    p = 1.5 * torch.from_numpy(ball_rays(5000)[0]) * torch.rand(5000, 1)
    lit = network.points_lit(p, light, torch.float32)
    by_depth = ShadowNetwork.points_lit(network, p, light, torch.float32)
    for bias in (-0.02, 0.0, 0.05):
        # Samples lie at other places.
        assert (lit(bias) == by_depth(bias)).float().mean() > 0.99
        assert 0.03 < lit(bias).float().mean() < 0.97


def test_training_from_distances_starts_with_a_lower_loss(tmp_path):
    """Its first loss is far below that of undecided values."""
    losses = []
    for start in ("distances", "undecided"):
        shape = trimesh.creation.icosphere(4, radius=0.5)
        network = laid_out(shape, tmp_path, SOLID_32 | {"start": start})
        generator = torch.Generator().manual_seed(0)
        result, _ = network.losses(ball_batch(3000), DeadZone(), torch.float32, generator)
        losses.append(result.mean().item())
    assert losses[0] < 0.3 < 0.6 < losses[1] == pytest.approx(np.log(2), abs=0.01)

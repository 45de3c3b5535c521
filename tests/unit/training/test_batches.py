"""Samples of a step: uniform, and equal on every device."""

import numpy as np
import pytest
import torch
from rays import ball_rays, open_rays
from scipy import stats

from neural_shadows.rays.ray_set import RaySet
from neural_shadows.training.batches import (
    GAMMA,
    DeviceRays,
    HostRays,
    batch_indices,
    split_mix,
)

CPU = torch.device("cpu")


def drawn(step: int, seed: int = 3, batch_size: int = 64, count: int = 1_000_000) -> np.ndarray:
    return batch_indices(torch.tensor(step), seed=seed, batch_size=batch_size, count=count).numpy()


def test_numbers_of_the_published_generator():
    """SplitMix64 from the state 1234567, as Rosetta Code lists them."""
    states = 1234567 + GAMMA * torch.arange(1, 6)
    assert split_mix(states).numpy().astype(np.uint64).tolist() == [
        6457827717110365317,
        3203168211198807973,
        9817491932198370423,
        4593380528125082431,
        16408922859458223821,
    ]


def test_batches_are_uniform_and_in_range():
    batches = [drawn(step, batch_size=500, count=50) for step in range(40)]
    counts = np.bincount(np.concatenate(batches), minlength=50)
    assert len(counts) == 50  # 0 to 49, each of them
    assert stats.chisquare(counts).pvalue > 1e-3
    assert batches[0].shape == (500,) and batches[0].dtype == np.int64


@pytest.fixture
def ray_set(tmp_path) -> RaySet:
    """Seven directions of five rays each, in two shards."""
    o, _, t_lb, t_ub = ball_rays(35)
    d = ball_rays(7, seed=1)[1]
    origins, bounds = o.reshape(7, 5, 3), np.stack([t_lb, t_ub], axis=1).reshape(7, 5, 2)
    np.save(tmp_path / "directions.npy", d)
    for shard, part in enumerate((slice(0, 3), slice(3, 7))):
        np.save(tmp_path / f"origins.{shard:03}.npy", origins[part])
        np.save(tmp_path / f"bounds.{shard:03}.npy", bounds[part])
    return open_rays(tmp_path)


def test_rays_on_a_device_are_those_on_disk(ray_set):
    indices = torch.from_numpy(np.random.default_rng(0).permutation(ray_set.count))
    expected = ray_set.gather(indices.numpy())
    for source in (HostRays(ray_set, CPU), DeviceRays(ray_set, CPU)):
        for gathered, part in zip(source.gather(indices), expected, strict=True):
            assert torch.equal(gathered, torch.from_numpy(part))

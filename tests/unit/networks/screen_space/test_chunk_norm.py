"""Chunk norms against PyTorch's batch norms."""

from concurrent.futures import ThreadPoolExecutor

import torch
from torch import nn

from neural_shadows.networks.screen_space.chunk_norm import ChunkNorm, chunk_statistics


def batch(count=6, dtype=torch.float32):
    generator = torch.Generator().manual_seed(0)
    return (2 + 3 * torch.randn(count, 5, 8, 8, generator=generator)).to(dtype)


def test_a_chunk_is_normalised_as_a_batch_is():
    ours, theirs, x = ChunkNorm(5), nn.BatchNorm2d(5), batch()
    with chunk_statistics() as statistics:
        output = ours(x)
    assert torch.equal(output, theirs(x)) and len(statistics) == 1
    assert torch.equal(ours.running_mean, torch.zeros(5))  # until it is told
    ours.update(statistics)
    assert torch.allclose(ours.running_mean, theirs.running_mean)
    assert torch.allclose(ours.running_var, theirs.running_var)
    assert torch.allclose(ours(x), theirs.eval()(x), atol=1e-6)


def test_running_statistics_are_those_of_all_chunks_together():
    ours, theirs, x = ChunkNorm(5), nn.BatchNorm2d(5), batch()
    x[:3] += 4
    theirs(x)
    statistics = []
    for chunk in x.split(3):
        with chunk_statistics() as recorded:
            ours(chunk)
        statistics += recorded
    ours.update(statistics)
    assert torch.allclose(ours.running_mean, theirs.running_mean)
    # Of 192 numbers one less counts, twice.
    assert torch.allclose(ours.running_var, theirs.running_var, rtol=1e-2)


def test_threads_have_statistics_of_their_own():
    """One trains while another answers with the running ones."""
    norm, x = ChunkNorm(5), batch()

    def statistics_of(number):
        with chunk_statistics() as statistics:
            norm(x[number : number + 1])
        return statistics[0]

    with chunk_statistics() as mine, ThreadPoolExecutor(3) as pool:
        output = list(pool.map(statistics_of, range(6)))
        still = pool.submit(norm, x).result()
    assert not mine and torch.allclose(still, x, rtol=1e-4)
    for number, recorded in enumerate(output):
        assert torch.allclose(recorded.mean, x[number].mean((1, 2)), atol=1e-5)


def test_bfloat16_keeps_statistics_in_float32():
    norm = ChunkNorm(5)
    with chunk_statistics() as statistics:
        assert norm(batch(dtype=torch.bfloat16)).dtype == torch.bfloat16
    assert {recorded.dtype for recorded in statistics[0]} == {torch.float32}

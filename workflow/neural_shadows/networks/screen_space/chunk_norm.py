"""Batch normalisation by chunk, for steps computed in threads."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from typing import NamedTuple

import torch
from torch import Tensor, nn
from torch.nn import functional

EPSILON, MOMENTUM = 1e-5, 0.1  # PyTorch's


class Statistics(NamedTuple):
    """Mean and variance of a chunk's channels, (C,) float32 each."""

    mean: Tensor
    variance: Tensor


_STATISTICS: ContextVar[list[Statistics] | None] = ContextVar("statistics", default=None)


@contextmanager
def chunk_statistics() -> Iterator[list[Statistics]]:
    """Record the statistics of this thread's chunk norms.

    Meanwhile they normalise by the chunk's own statistics; elsewhere, and in other threads, by the
    running ones.
    """
    statistics: list[Statistics] = []
    token = _STATISTICS.set(statistics)
    try:
        yield statistics
    finally:
        _STATISTICS.reset(token)


class ChunkNorm(nn.Module):
    """Batch normalisation (Ioffe and Szegedy 2015) by a chunk's own statistics.

    A chunk's output depends on the chunk and the weights alone, whatever the threads and their
    order (ghost batch normalisation, Hoffer et al. 2017). Only `update` changes running statistics.
    """

    def __init__(self, channels: int):
        super().__init__()
        self.weight, self.bias = (nn.Parameter(torch.empty(channels)) for _ in range(2))
        for name in ("running_mean", "running_var"):
            self.register_buffer(name, torch.empty(channels))
        self.eps = EPSILON  # named for `fuse_conv_bn_eval`
        self.reset()

    def reset(self) -> None:
        """Reset to the identity."""
        for name, tensor in (*self.named_parameters(), *self.named_buffers()):
            tensor.data.fill_(0 if name in ("bias", "running_mean") else 1)

    def forward(self, x: Tensor) -> Tensor:
        """(B, C, H, W), in the format of x."""
        mean, variance, statistics = self.running_mean, self.running_var, _STATISTICS.get()
        if statistics is not None:
            mean, variance = torch.zeros_like(mean), torch.zeros_like(variance)
            statistics.append(Statistics(mean, variance))
        own = statistics is not None
        # With momentum 1 it leaves a chunk's own statistics in both.
        return functional.batch_norm(x, mean, variance, self.weight, self.bias, own, 1.0, self.eps)

    def update(self, chunks: Sequence[Statistics]) -> None:
        """Move the running statistics by a tenth to a step's.

        Args:
            chunks: of all of its pixels, of one size, added in their order.
        """
        means = torch.stack([chunk.mean for chunk in chunks])
        mean = means.mean(0)
        variance = torch.stack([chunk.variance for chunk in chunks]).mean(0)
        variance = variance + (means - mean).square().mean(0)
        self.running_mean.lerp_(mean, MOMENTUM)
        self.running_var.lerp_(variance, MOMENTUM)

"""Batch normalisation of a step that threads compute in chunks, each alone."""

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


_SEEN: ContextVar[list[Statistics] | None] = ContextVar("statistics", default=None)


@contextmanager
def chunk_statistics() -> Iterator[list[Statistics]]:
    """While it lasts, this thread's chunk norms take the statistics of what they are given, and add
    them to this list. Elsewhere, and in other threads, they take the running ones.
    """
    seen: list[Statistics] = []
    token = _SEEN.set(seen)
    try:
        yield seen
    finally:
        _SEEN.reset(token)


class ChunkNorm(nn.Module):
    """Batch normalisation (Ioffe and Szegedy 2015) with the statistics of one chunk of a batch.

    A chunk's answer depends on nothing but the chunk and the weights, however many threads compute
    and in whatever order (ghost batch normalisation, Hoffer et al. 2017). Running statistics are
    changed by `update` alone.
    """

    def __init__(self, channels: int):
        super().__init__()
        self.weight, self.bias = (nn.Parameter(torch.empty(channels)) for _ in range(2))
        for name in ("running_mean", "running_var"):
            self.register_buffer(name, torch.empty(channels))
        self.eps = EPSILON  # under the name that `fuse_conv_bn_eval` asks for
        self.reset()

    def reset(self) -> None:
        """To where a training starts: it changes nothing."""
        for name, one in (*self.named_parameters(), *self.named_buffers()):
            one.data.fill_(0 if name in ("bias", "running_mean") else 1)

    def forward(self, x: Tensor) -> Tensor:
        """(B, C, H, W), in the format of x."""
        mean, variance, seen = self.running_mean, self.running_var, _SEEN.get()
        if seen is not None:
            mean, variance = torch.zeros_like(mean), torch.zeros_like(variance)
            seen.append(Statistics(mean, variance))
        own = seen is not None
        # Of momentum 1 it leaves a chunk's own statistics in both.
        return functional.batch_norm(x, mean, variance, self.weight, self.bias, own, 1.0, self.eps)

    def update(self, chunks: Sequence[Statistics]) -> None:
        """Move the running statistics by a tenth to those of all pixels of a step.

        Args:
            chunks: of one size, added in their order.
        """
        means = torch.stack([one.mean for one in chunks])
        mean = means.mean(0)
        variance = torch.stack([one.variance for one in chunks]).mean(0)
        variance = variance + (means - mean).square().mean(0)
        self.running_mean.lerp_(mean, MOMENTUM)
        self.running_var.lerp_(variance, MOMENTUM)

"""The common interface of networks of whole frames."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence

import numpy as np
import torch
from torch import Tensor, nn

from neural_shadows.networks.screen_space.chunk_norm import ChunkNorm, Statistics


class ScreenNetwork(nn.Module, ABC):
    """Visibility (B, 1, H, W) from planes (B, C, H, W) float32.

    Of any H and W. A form of network is a file of `forms/`, and a class if none of these is right.
    """

    features: tuple[str, ...]  # names in FEATURES; their channels are the planes, in this order
    reach = 1  # of kernels, in pixels of a side

    @abstractmethod
    def initialise(self, seed: int) -> None:
        """Set the first weights: the same of a seed, everywhere."""

    def normalise(self, ranges: Callable[[], tuple[np.ndarray, np.ndarray]]) -> None:
        """Take the means and deviations of a training's channels.

        Here they are of no use, and `ranges` is not called.

        Args:
            ranges: for means and standard deviations, (C,) float32 each.
        """

    @abstractmethod
    def learned(self, x: Tensor) -> Tensor:
        """Visibility, or a function of it, for a training's loss."""

    def aim(self, target: Tensor) -> Tensor:
        """The target of `learned`, of visibility; here that itself."""
        return target

    @abstractmethod
    def hidden(self) -> list[str]:
        """Names of all convolutions' weights but the first and last."""

    @abstractmethod
    def in_format(self, dtype: torch.dtype) -> "ScreenNetwork":
        """A copy with its convolutions in a number format."""

    def for_inference(self) -> "ScreenNetwork":
        """The network for inference alone; here itself."""
        return self

    def norms(self) -> list[ChunkNorm]:
        """Batch norms in the order of their computation.

        With any, a training's chunk is of two crops.
        """
        return []

    def update_norms(self, chunks: Sequence[Sequence[Statistics]]) -> None:
        """Move the running statistics to those of a step.

        Args:
            chunks: the step's, each from `chunk_statistics`.
        """
        for norm, *seen in zip(self.norms(), *chunks, strict=True):
            norm.update(seen)

    @abstractmethod
    def parts(self) -> dict[tuple[int, str], nn.Module]:
        """Modules by level and part, such as `encoder`."""

"""Common interface of screen-space networks."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence

import numpy as np
import torch
from torch import Tensor, nn

from neural_shadows.networks.screen_space.chunk_norm import ChunkNorm, Statistics


class ScreenNetwork(nn.Module, ABC):
    """Visibility (B, 1, H, W) from planes (B, C, H, W) float32.

    Of any H and W. A form of network is a file of `forms/`, if needed with a class of its own.
    """

    features: tuple[str, ...]  # names in FEATURES; their channels are the planes, in this order
    reach = 1  # of kernels, in pixels of a side
    of_its_base = False  # whether a constant base makes a constant output, whatever the weights

    @abstractmethod
    def initialise(self, seed: int) -> None:
        """Set the initial weights, determined by the seed."""

    def normalise(self, ranges: Callable[[], tuple[np.ndarray, np.ndarray]]) -> None:
        """Take means and deviations of a training's channels.

        Unused here: `ranges` is not called.

        Args:
            ranges: returns means and standard deviations, (C,) float32 each.
        """

    @abstractmethod
    def loss_input(self, x: Tensor) -> Tensor:
        """Visibility, or a function of it, for a training's loss."""

    def loss_target(self, target: Tensor) -> Tensor:
        """Target of `loss_input` from visibility; here visibility itself."""
        return target

    def in_bands(self, x: Tensor) -> Tensor:
        """`forward` for inference: by bands of rows on a CPU, see `row_bands.py`."""
        with torch.inference_mode():
            return self._in_bands(x) if x.device.type == "cpu" else self(x)

    def _in_bands(self, x: Tensor) -> Tensor:
        """`in_bands` on a CPU; a form without bands has its layers one after another."""
        return self(x)

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
        """Batch norms in order of computation.

        With norms, a training's chunk has two crops.
        """
        return []

    def update_norms(self, chunks: Sequence[Sequence[Statistics]]) -> None:
        """Move the running statistics to those of a step.

        Args:
            chunks: the step's, each from `chunk_statistics`.
        """
        for norm, *statistics in zip(self.norms(), *chunks, strict=True):
            norm.update(statistics)

    @abstractmethod
    def parts(self) -> dict[tuple[int, str], nn.Module]:
        """Modules by level and part, such as `encoder`."""

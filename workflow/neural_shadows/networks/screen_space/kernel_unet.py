"""The network of Kernel Predicting Neural Shadow Maps.

From a frame's planes to kernels, or to visibility.
"""

import math
from collections.abc import Sequence
from copy import deepcopy

import torch
from torch import Tensor, nn

from neural_shadows.frames.feature_names import FEATURES, GUIDE, base_of
from neural_shadows.networks.screen_space import row_bands
from neural_shadows.networks.screen_space.chunk_norm import ChunkNorm
from neural_shadows.networks.screen_space.kernel_parts import (
    KernelLevel,
    PixelKernels,
    PlanesOfLogits,
    fold,
    normed,
)
from neural_shadows.networks.screen_space.kernel_widths import FIRST_LEVELS, kernel_convolutions
from neural_shadows.networks.screen_space.layers import (
    SquaresAsChannels,
    doubled,
    down_and_up,
    initialise,
    padded,
)
from neural_shadows.networks.screen_space.screen_network import ScreenNetwork

_CONVOLUTIONS = nn.Conv2d | nn.ConvTranspose2d


class KernelUnet(ScreenNetwork):
    """A U-Net of kernels: batch norms, additive skips (Hu et al. 2025, 4.2.1, and its code).

    The last 1 × 1 convolution of the kernels precedes the bilinear enlargement, at half the
    resolution: both orders are equal, and this one is a quarter of the work.

    Args:
        form: `kernels`, which filter its feature in BASES; `direct`, which outputs visibility: the
            paper's form of Neural Shadow Mapping.
        widths: channels of each level, from that of half the frame's resolution, or with full ends
            from that of the frame's own.
        features: names in FEATURES; their planes are the input, in this order, without any scaling.
        filters: 5 × 5 kernels of a pixel, of dilation 1, 2, 4 …
        ends: of the kernels, `half` (2 × 2 pixels as channels, and a bilinear enlargement) or
            `full`.
        edge: largest difference of the feature `log_d` within a kernel; None for any.

    Its norms use running statistics, except in training, inside `chunk_statistics`.

    Raises:
        KeyError, ValueError: unknown feature or ends, or not exactly one base.
    """

    def __init__(
        self,
        form: str,
        widths: Sequence[int],
        features: Sequence[str],
        filters: int = 4,
        ends: str = "half",
        edge: float | None = None,
    ):
        super().__init__()
        self.form, self.features, self.filters = form, tuple(features), filters
        channels = [FEATURES[name] for name in self.features]
        layers = kernel_convolutions(form, widths, sum(channels), filters, ends)
        self.of_its_base = form == "kernels"
        if self.of_its_base:
            base = self.features.index(base_of(self.features))
            self._base = sum(channels[:base])  # index of its plane
            guide = base if edge is None else self.features.index(GUIDE)
            self._guide = sum(channels[:guide])
        self._first = FIRST_LEVELS[ends]
        last_level = self._first + len(widths) - 1
        self.multiple = 2**last_level
        self.entrance = SquaresAsChannels() if self._first else nn.Identity()
        numbers = range(self._first, last_level + 1)
        of_level = [[layer for layer in layers if layer.level == k] for k in numbers]
        self.levels = nn.ModuleList(KernelLevel(level) for level in of_level[:-1])
        self.deepest = normed(of_level[-1], "encoder")
        last = [layer for layer in layers if layer.part == "head"]
        if form == "kernels":
            self.head = PlanesOfLogits(last[0].inputs, last[0].outputs, 1)
            self.exit = PixelKernels(2**self._first, math.inf if edge is None else edge)
        else:
            before, output = (
                nn.Conv2d(x.inputs, x.outputs, x.size, padding=x.size // 2) for x in last
            )
            norm = ChunkNorm(last[0].outputs)
            self.head = nn.Sequential(before, norm, nn.ReLU(inplace=True), output)
            self.exit = doubled()
        self.initialise(0)

    def initialise(self, seed: int) -> None:
        """Set the initial weights, determined by the seed."""
        generator = torch.Generator().manual_seed(seed)
        for layer in self.modules():
            if isinstance(layer, _CONVOLUTIONS):
                initialise(layer, generator)
            elif isinstance(layer, ChunkNorm):
                layer.reset()
        if self.form == "kernels":
            self.head.start_at_the_base()

    def forward(self, x: Tensor) -> Tensor:
        """Visibility, (B, 1, H, W) float32, of planes (B, C, H, W) float32 of any H and W.

        Not clamped to [0, 1] by the direct form.
        """
        height, width = x.shape[-2:]
        inner = self.inner(x)
        if self.form == "kernels":
            return self.exit(self.head(inner), *self._filtered_by(x))
        return self.head(self.exit(inner))[..., :height, :width].float()

    def _filtered_by(self, x: Tensor) -> tuple[Tensor, Tensor]:
        """Base and guide among planes (B, C, H, W)."""
        return tuple(x[:, plane : plane + 1].float() for plane in (self._base, self._guide))

    def loss_input(self, x: Tensor) -> Tensor:
        """Visibility, for a training's loss."""
        return self(x)

    @property
    def reach(self) -> int:
        """Side of its kernels in pixels; 1 for the direct form."""
        return 1 + 4 * (2**self.filters - 1) if self.form == "kernels" else 1

    def inner(self, x: Tensor) -> Tensor:
        """Input of the head: (B, C, h, w) at its ends' resolution."""
        x = padded(x.to(next(self.parameters()).dtype), self.multiple)
        return down_and_up(self.levels, self.deepest, self.entrance(x))

    def _in_bands(self, x: Tensor) -> Tensor:
        height, width = x.shape[-2:]
        dtype = next(self.parameters()).dtype
        rows = row_bands.stored(padded(x, self.multiple))
        rows = row_bands.mapped(lambda rows: rows.to(dtype), rows)
        rows = row_bands.through(self.entrance, rows)
        rows = row_bands.unet(self.levels, self.deepest, rows)
        if self.form == "kernels":
            base, guide = self._filtered_by(x)
            inner, exit_ = row_bands.computed(rows), self.exit
            return row_bands.filtered(self.head, inner, base, exit_.factor, guide, exit_.limit)
        rows = row_bands.through(self.head, row_bands.through(self.exit, rows))
        return row_bands.computed(rows)[..., :height, :width].float()

    def hidden(self) -> list[str]:
        """Names of all convolutions' weights but the first and last."""
        names = [name for name, part in self.named_modules() if isinstance(part, _CONVOLUTIONS)]
        ends = {names[0], "head" if self.form == "kernels" else "head.3"}
        return [f"{name}.weight" for name in names if name not in ends]

    def in_format(self, dtype: torch.dtype) -> "KernelUnet":
        """A copy with convolutions in a format, norms in float32."""
        network = deepcopy(self).to(memory_format=torch.channels_last)
        for layer in network.modules():
            if isinstance(layer, _CONVOLUTIONS):
                layer.to(dtype)
        return network

    def for_inference(self) -> "KernelUnet":
        """A copy with norms folded into convolutions."""
        network = deepcopy(self)
        for block in network.modules():
            if isinstance(block, nn.Sequential):
                fold(block)
        return network

    def norms(self) -> list[ChunkNorm]:
        """Batch norms in order of computation."""
        levels = [*self.levels]
        blocks = [level.encoder for level in levels] + [self.deepest]
        blocks += [level.decoder for level in reversed(levels)] + [self.head]
        return [
            layer for block in blocks for layer in block.modules() if isinstance(layer, ChunkNorm)
        ]

    def parts(self) -> dict[tuple[int, str], nn.Module]:
        """Modules by level and part.

        Parts: `entrance`, `exit` (level 0), `encoder`, `downsample`, `upsample`, `skip`, `decoder`,
        `head` (the first level of kernels, level 0 of the direct form).
        """
        parts = {(0, "entrance"): self.entrance, (0, "exit"): self.exit}
        for number, level in enumerate(self.levels, self._first):
            parts |= {(number, name): part for name, part in level.named_children()}
        parts[(self._first + len(self.levels), "encoder")] = self.deepest
        return parts | {(self._first * (self.form == "kernels"), "head"): self.head}

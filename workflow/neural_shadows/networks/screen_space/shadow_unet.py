"""The network of Neural Shadow Mapping in all its forms."""

from collections.abc import Callable, Sequence
from copy import deepcopy

import numpy as np
import torch
from torch import Tensor, nn

from neural_shadows.frames.feature_names import channels_of
from neural_shadows.networks.screen_space import row_bands
from neural_shadows.networks.screen_space.layers import (
    Concatenation,
    Halved,
    SquareOfPixels,
    SquaresAsChannels,
    Sum,
    doubled,
    down_and_up,
    initialise,
    padded,
    stacked,
)
from neural_shadows.networks.screen_space.screen_network import ScreenNetwork
from neural_shadows.networks.screen_space.widths import (
    Convolution,
    Widths,
    convolutions,
    deepest_level,
    first_level,
)

POOLS = {"average": nn.AvgPool2d, "max": nn.MaxPool2d}


class Level(nn.Module):
    """A level above the deepest, down and up."""

    def __init__(self, layers: Sequence[Convolution], pool: str, skip: nn.Module | None, end: bool):
        super().__init__()
        parts = {name: [x for x in layers if x.part == name] for name in PARTS_OF_LAYERS}
        self.encoder = stacked(parts["encoder"])
        self.downsample = POOLS[pool](2)
        # Transposed convolutions have no activation of their own.
        self.upsample = stacked(parts["upsample"], True) if parts["upsample"] else doubled()
        self.skip = skip
        self.decoder = stacked(parts["decoder"], linear_end=end)


PARTS_OF_LAYERS = ("encoder", "upsample", "decoder")


class ShadowUnet(ScreenNetwork):
    """A U-Net from a table of widths (Datta et al. 2022, 3.5, S3, S4.1).

    Args:
        form: `full`, the trimmed network; `shuffle`, its fast form, with 2 × 2 pixels as channels
            of the first level; `half`, at half the resolution; `original`, before trimming: two 3 ×
            3 convolutions a level, concatenation, transposed convolutions, max pool.
        widths: of each level, a number or [mid, out], see `widths.py`.
        features: names in FEATURES; their channels are the input's, in this order.
        pool: `average` or `max`. first_skip: a skip at the level of the frame's own size; the other
            levels always have one.
        extraction: hidden channels of a learned reduction to four channels in front (3.2).

    Channels are normalised by `centres` and `spreads`, means and standard deviations over a
    training's frames, see `normalise`. The latter differ by 60 times; and bfloat16's steps of 0.004
    for a ratio near 1 are larger than most shadow rims' distance from it. So the input is float32,
    whatever format the weights have, see `in_format`.

    Raises:
        KeyError: unknown pool or feature.
    """

    def __init__(
        self,
        form: str,
        widths: Widths,
        features: Sequence[str],
        pool: str = "average",
        first_skip: bool = False,
        extraction: int | None = None,
    ):
        super().__init__()
        self.features = tuple(features)
        channels = channels_of(self.features)
        layers = convolutions(form, widths, channels, extraction)
        first, deepest = first_level(form), deepest_level(form, widths)
        original = form == "original"
        self.first, self.multiple = first, 2**deepest
        reduction = [layer for layer in layers if layer.part == "extraction"]
        self.extraction = stacked(reduction, linear_end=True) if reduction else None
        self.entrance = {"shuffle": SquaresAsChannels(), "half": Halved()}.get(form)
        self.exit = {"shuffle": SquareOfPixels(), "half": doubled()}.get(form)
        self.levels = nn.ModuleList(
            Level(
                [x for x in layers if x.level == level and x.part != "extraction"],
                "max" if original else pool,
                Concatenation() if original else Sum() if level or first_skip else None,
                end=level == first,
            )
            for level in range(first, deepest)
        )
        self.deepest = stacked([layer for layer in layers if layer.level == deepest])
        self.register_buffer("centres", torch.zeros(channels))
        self.register_buffer("spreads", torch.ones(channels))
        self.initialise(0)

    def initialise(self, seed: int) -> None:
        """Set the initial weights, determined by the seed.

        The output starts about a half: the bias of its first channel is 0.5.
        """
        generator = torch.Generator().manual_seed(seed)
        for layer in self.modules():
            if isinstance(layer, nn.Conv2d | nn.ConvTranspose2d):
                initialise(layer, generator)
        with torch.no_grad():
            self.levels[0].decoder[-1].bias[0] = 0.5

    def forward(self, x: Tensor) -> Tensor:
        """Visibility, not clamped to [0, 1]: (B, 1, H, W)."""
        return self.loss_input(x)

    def normalise(self, ranges: Callable[[], tuple[np.ndarray, np.ndarray]]) -> None:
        """Take means as `centres` and standard deviations as `spreads`."""
        for buffer, values in zip((self.centres, self.spreads), ranges()):
            buffer.copy_(torch.from_numpy(values))

    def loss_input(self, x: Tensor) -> Tensor:
        """Visibility, for a training's loss."""
        x = (x - self.centres[:, None, None]) / self.spreads[:, None, None]
        x = x.to(next(self.parameters()).dtype)
        height, width = x.shape[-2:]
        x = padded(x, self.multiple)
        for module in (self.extraction, self.entrance):
            x = x if module is None else module(x)
        x = down_and_up(self.levels, self.deepest, x)
        x = x if self.exit is None else self.exit(x)
        return x[..., :height, :width]

    def _in_bands(self, x: Tensor) -> Tensor:
        dtype = next(self.parameters()).dtype
        height, width = x.shape[-2:]
        centres, spreads = self.centres[:, None, None], self.spreads[:, None, None]
        rows = row_bands.stored(padded(x, self.multiple))
        rows = row_bands.mapped(lambda rows: (rows - centres).div_(spreads).to(dtype), rows)
        for module in (self.extraction, self.entrance):
            rows = row_bands.through(module, rows)
        rows = row_bands.unet(self.levels, self.deepest, rows)
        rows = row_bands.through(self.exit, rows)
        return row_bands.computed(rows)[..., :height, :width]

    def hidden(self) -> list[str]:
        """Names of all convolutions' weights but the first and last."""
        layers = (nn.Conv2d, nn.ConvTranspose2d)
        names = [name for name, part in self.named_modules() if isinstance(part, layers)]
        last = f"levels.0.decoder.{len(self.levels[0].decoder) - 1}"
        return [f"{name}.weight" for name in names[1:] if name != last]

    def in_format(self, dtype: torch.dtype) -> "ShadowUnet":
        """A copy in a number format, except centres and spreads."""
        network = deepcopy(self).to(memory_format=torch.channels_last)
        for weight in network.parameters():
            weight.data = weight.data.to(dtype)
        return network

    def parts(self) -> dict[tuple[int, str], nn.Module]:
        """Modules by level and part.

        Parts: `extraction`, `entrance`, `exit` (level 0), `encoder`, `downsample`, `upsample`,
        `skip`, `decoder`.
        """
        parts = {(0, name): getattr(self, name) for name in ("extraction", "entrance", "exit")}
        for number, level in enumerate(self.levels, self.first):
            parts |= {(number, name): part for name, part in level.named_children()}
        parts[(self.first + len(self.levels), "encoder")] = self.deepest
        return {key: part for key, part in parts.items() if part is not None}

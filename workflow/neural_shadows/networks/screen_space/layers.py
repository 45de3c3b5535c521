"""Parts of screen-space networks, as modules for timing."""

from collections.abc import Sequence

import torch
from torch import Tensor, nn
from torch.nn import functional

from neural_shadows.networks.screen_space.widths import Convolution


class ReplicatedConvolution(nn.Conv2d):
    """Convolution of equal output size with replicated border pixels."""

    def forward(self, x: Tensor) -> Tensor:
        border = self.kernel_size[0] // 2
        if border:
            x = functional.pad(x, [border] * 4, mode="replicate")
        return functional.conv2d(x, self.weight, self.bias)


class Sum(nn.Module):
    """Add encoder output to the decoder input, in place."""

    def forward(self, below: Tensor, encoded: Tensor) -> Tensor:
        return below.add_(encoded)


class Concatenation(nn.Module):
    """Concatenate both."""

    def forward(self, below: Tensor, encoded: Tensor) -> Tensor:
        return torch.cat([encoded, below], dim=1)


class Halved(nn.Module):
    """Halve the resolution: the mean of each 2 × 2 square."""

    def forward(self, x: Tensor) -> Tensor:
        return functional.avg_pool2d(x, 2)


class SquaresAsChannels(nn.Module):
    """`PixelUnshuffle(2)`, of channels-last pictures two to three times as fast."""

    def forward(self, x: Tensor) -> Tensor:
        pixels = x.permute(0, 2, 3, 1)
        squares = [pixels[:, row::2, column::2] for row in (0, 1) for column in (0, 1)]
        return torch.stack(squares, -1).flatten(3).permute(0, 3, 1, 2)


class SquareOfPixels(nn.Module):
    """Four channels as 2 × 2 pixels (Datta et al. 2022, 3.5).

    The first is enlarged bilinearly; the others are added to the upper right, lower left and lower
    right pixel of each square.
    """

    def forward(self, o: Tensor) -> Tensor:
        smooth = doubled()(o[:, :1])
        detail = torch.cat([torch.zeros_like(o[:, :1]), o[:, 1:]], dim=1)
        return smooth + functional.pixel_shuffle(detail, 2)


def doubled() -> nn.Module:
    """Bilinear enlargement by two; image corners stay in place."""
    return nn.Upsample(scale_factor=2, mode="bilinear", align_corners=False)


def padded(x: Tensor, multiple: int) -> Tensor:
    """Pad sides to multiples by repeating last rows and columns."""
    below, right = (-side % multiple for side in x.shape[-2:])
    return functional.pad(x, (0, right, 0, below), mode="replicate") if below or right else x


def down_and_up(levels: nn.ModuleList, deepest: nn.Module, x: Tensor) -> Tensor:
    """Evaluate a U-Net: encoder and downsample; the deepest; upsample, any skip, decoder."""
    skips = []
    for level in levels:
        x = level.encoder(x)
        skips.append(x)
        x = level.downsample(x)
    x = deepest(x)
    for level in reversed(levels):
        x, encoded = level.upsample(x), skips.pop()
        x = level.decoder(x if level.skip is None else level.skip(x, encoded))
    return x


def stacked(layers: Sequence[Convolution], linear_end: bool = False) -> nn.Sequential:
    """Convolutions with ReLUs, the last without for a linear end."""
    modules: list[nn.Module] = []
    for layer in layers:
        modules += [module_of(layer), nn.ReLU(inplace=True)]
    return nn.Sequential(*(modules[:-1] if linear_end else modules))


def module_of(layer: Convolution) -> nn.Module:
    """The module of a convolution."""
    if layer.transposed:
        return nn.ConvTranspose2d(layer.inputs, layer.outputs, layer.size, stride=layer.size)
    return ReplicatedConvolution(layer.inputs, layer.outputs, layer.size)


def initialise(layer: nn.Conv2d | nn.ConvTranspose2d, generator: torch.Generator) -> None:
    """He's normal weights, and biases of zero."""
    transposed = isinstance(layer, nn.ConvTranspose2d)
    # Each output of a transposed one has one input pixel, without overlap.
    inputs = layer.in_channels * (1 if transposed else layer.weight[0, 0].numel())
    normals = torch.randn(layer.weight.shape, generator=generator)
    with torch.no_grad():
        layer.weight.copy_((2 / inputs) ** 0.5 * normals)
        if layer.bias is not None:
            layer.bias.zero_()

"""Parts of networks of whole frames, each a module to be timed."""

from collections.abc import Sequence

import torch
from torch import Tensor, nn
from torch.nn import functional

from neural_shadows.networks.screen_space.widths import Convolution


class ReplicatedConvolution(nn.Conv2d):
    """A convolution of the same size out as in, whose border pixels are repeated outwards."""

    def forward(self, x: Tensor) -> Tensor:
        border = self.kernel_size[0] // 2
        if border:
            x = functional.pad(x, [border] * 4, mode="replicate")
        return functional.conv2d(x, self.weight, self.bias)


class Sum(nn.Module):
    """Adds what a level's encoder left to what comes up from below, in the latter's memory."""

    def forward(self, below: Tensor, kept: Tensor) -> Tensor:
        return below.add_(kept)


class Concatenation(nn.Module):
    """Puts both beside each other."""

    def forward(self, below: Tensor, kept: Tensor) -> Tensor:
        return torch.cat([kept, below], dim=1)


class Halved(nn.Module):
    """A frame at half its resolution, bilinearly: the mean of each 2 × 2 square."""

    def forward(self, x: Tensor) -> Tensor:
        return functional.avg_pool2d(x, 2)


class SquareOfPixels(nn.Module):
    """Four channels become the 2 × 2 pixels of each of their own (Datta et al. 2022, 3.5).

    The first is enlarged bilinearly; the others are added to the right upper, left lower and right
    lower pixel of each square.
    """

    def forward(self, o: Tensor) -> Tensor:
        smooth = doubled()(o[:, :1])
        detail = torch.cat([torch.zeros_like(o[:, :1]), o[:, 1:]], dim=1)
        return smooth + functional.pixel_shuffle(detail, 2)


def doubled() -> nn.Module:
    """Bilinear enlargement by two; corners of images, not of pixel centres, stay in place."""
    return nn.Upsample(scale_factor=2, mode="bilinear", align_corners=False)


def padded(x: Tensor, multiple: int) -> Tensor:
    """Pictures whose sides are multiples of a number: their last rows and columns are repeated."""
    below, right = (-side % multiple for side in x.shape[-2:])
    return functional.pad(x, (0, right, 0, below), mode="replicate") if below or right else x


def down_and_up(levels: nn.ModuleList, deepest: nn.Module, x: Tensor) -> Tensor:
    """What a U-Net makes of its finest level's input: of each level `encoder` and `downsample`, then
    the deepest, and back by `upsample`, `skip` (None for none) and `decoder`.
    """
    kept = []
    for level in levels:
        x = level.encoder(x)
        kept.append(x)
        x = level.downsample(x)
    x = deepest(x)
    for level in reversed(levels):
        x, beside = level.upsample(x), kept.pop()
        x = level.decoder(x if level.skip is None else level.skip(x, beside))
    return x


def stacked(layers: Sequence[Convolution], linear_end: bool = False) -> nn.Sequential:
    """Convolutions with a ReLU after each, but for the last if the end is linear."""
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
    # Each output of a transposed one is of one input pixel, for these do not overlap.
    inputs = layer.in_channels * (1 if transposed else layer.weight[0, 0].numel())
    drawn = torch.randn(layer.weight.shape, generator=generator)
    with torch.no_grad():
        layer.weight.copy_((2 / inputs) ** 0.5 * drawn)
        if layer.bias is not None:
            layer.bias.zero_()

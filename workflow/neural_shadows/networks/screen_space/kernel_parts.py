"""Parts of networks of kernels, each a module to be timed."""

from collections.abc import Sequence

import torch
from torch import Tensor, nn
from torch.nn.utils.fusion import fuse_conv_bn_eval

from neural_shadows.networks.screen_space.chunk_norm import ChunkNorm
from neural_shadows.networks.screen_space.layers import Sum
from neural_shadows.networks.screen_space.pixel_kernel_loops import TAPS
from neural_shadows.networks.screen_space.pixel_kernels import filtered
from neural_shadows.networks.screen_space.widths import Convolution


class KernelLevel(nn.Module):
    """A level but the deepest, on the way down and up."""

    def __init__(self, layers: Sequence[Convolution]):
        super().__init__()
        self.encoder = normed(layers, "encoder")
        self.downsample = nn.MaxPool2d(2)
        (raised,) = (layer for layer in layers if layer.part == "upsample")
        self.upsample = nn.ConvTranspose2d(raised.inputs, raised.outputs, 2, stride=2)
        self.skip = Sum()
        self.decoder = normed(layers, "decoder")


class PlanesOfLogits(nn.Conv2d):
    """A 1 × 1 convolution with output channel by channel.

    So the filter reads it.

    From channels-last to there a copy takes 8 ms of 256 × 128 pixels, 320 ms of 1024 × 512; as a
    product of matrices it needs none.
    """

    def start_at_the_base(self) -> None:
        """Make first kernels that leave most of their base as it is, instead of a blur of 61 pixels.

        Squared error × 1e-4 on validation windows after 300 steps of L1 (base 81): 54.6 instead of
        62.3; with the paper's widths after 600 of the whole loss 49.0 instead of 64.1. Larger and
        smaller biases, 6 and 2.5, end at 61.8 and 58.5.
        """
        with torch.no_grad():
            self.weight.mul_(0.1)
            self.bias.view(-1, TAPS)[:, TAPS // 2] += 4

    def forward(self, x: Tensor) -> Tensor:
        """(B, channels, H, W), contiguous."""
        weight, bias = self.weight.flatten(1), self.bias[:, None]
        planes = [torch.addmm(bias, weight, image.flatten(1)).view(-1, *x.shape[2:]) for image in x]
        return torch.stack(planes) if len(planes) > 1 else planes[0][None]


class PixelKernels(nn.Module):
    """The filter as a part of a network: of a frame's kernels, and its base; see `filtered`."""

    def __init__(self, factor: int):
        super().__init__()
        self.factor = factor

    def forward(self, logits: Tensor, base: Tensor) -> Tensor:
        """See `filtered`."""
        return filtered(logits, base, self.factor)


def normed(layers: Sequence[Convolution], part: str) -> nn.Sequential:
    """The convolutions of a part, with a norm and a ReLU after each; a 3 × 3 has no bias."""
    modules: list[nn.Module] = []
    for layer in layers:
        if layer.part == part:
            size, outputs = layer.size, layer.outputs
            convolution = nn.Conv2d(layer.inputs, outputs, size, padding=size // 2, bias=size == 1)
            modules += [convolution, ChunkNorm(outputs), nn.ReLU(inplace=True)]
    return nn.Sequential(*modules)


def fold(block: nn.Sequential) -> None:
    """Take the norms of a block into the convolutions before them."""
    for number in reversed(range(1, len(block))):
        if isinstance(block[number], ChunkNorm):
            block[number - 1] = fuse_conv_bn_eval(block[number - 1].eval(), block[number].eval())
            del block[number]

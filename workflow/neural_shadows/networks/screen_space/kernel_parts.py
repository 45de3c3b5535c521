"""Parts of networks of kernels, as modules for timing."""

from collections.abc import Sequence

import torch
from torch import Tensor, nn
from torch.nn.utils.fusion import fuse_conv_bn_eval

from neural_shadows.networks.screen_space.chunk_norm import ChunkNorm
from neural_shadows.networks.screen_space.kernel_taps import TAPS
from neural_shadows.networks.screen_space.layers import Sum
from neural_shadows.networks.screen_space.pixel_kernels import filtered
from neural_shadows.networks.screen_space.widths import Convolution


class KernelLevel(nn.Module):
    """A level above the deepest, down and up."""

    def __init__(self, layers: Sequence[Convolution]):
        super().__init__()
        self.encoder = normed(layers, "encoder")
        self.downsample = nn.MaxPool2d(2)
        (upsampling,) = (layer for layer in layers if layer.part == "upsample")
        self.upsample = nn.ConvTranspose2d(upsampling.inputs, upsampling.outputs, 2, stride=2)
        self.skip = Sum()
        self.decoder = normed(layers, "decoder")


class PlanesOfLogits(nn.Conv2d):
    """A 1 × 1 convolution with output in planes.

    A copy from channels-last takes 8 ms for 256 × 128 pixels, 320 ms for 1024 × 512; a matrix
    product needs none.
    """

    def start_at_the_base(self) -> None:
        """Initialise kernels near the identity instead of a 61-pixel blur.

        Squared error × 1e-4 on validation windows after 300 steps of L1 (base 81): 54.6 instead of
        62.3; with the paper's widths after 600 of the whole loss 49.0 instead of 64.1. Larger and
        smaller biases, 6 and 2.5, end at 61.8 and 58.5.
        """
        with torch.no_grad():
            self.weight.mul_(0.1)
            self.bias.view(-1, TAPS)[:, TAPS // 2] += 4

    def forward(self, x: Tensor) -> Tensor:
        """(B, channels, H, W), contiguous."""
        return _Planes.apply(x, self.weight.flatten(1), self.bias)


class _Planes(torch.autograd.Function):
    """`PlanesOfLogits` without copies; the input's gradient is in its memory format.

    torch's own is in planes, and a ReLU before them takes four times as long: 49 ms for two crops of
    128 × 128 × 32, forward and backward, instead of 35.
    """

    @staticmethod
    def forward(ctx, x: Tensor, weight: Tensor, bias: Tensor) -> Tensor:
        """(B, N, H, W) of (B, C, H, W), (N, C) and (N,)."""
        ctx.save_for_backward(x, weight)
        planes = x.new_empty((len(x), len(weight), *x.shape[2:]))
        for image, output in zip(x, planes):
            torch.addmm(bias[:, None], weight, image.flatten(1), out=output.flatten(1))
        return planes

    @staticmethod
    def backward(ctx, gradient: Tensor) -> tuple[Tensor, Tensor, Tensor]:
        """Gradients of all three."""
        x, weight = ctx.saved_tensors
        to_x, to_weight = torch.empty_like(x), torch.zeros_like(weight)
        for image, to_image, to_planes in zip(x, to_x, gradient.flatten(2)):
            torch.mm(to_planes.T, weight, out=to_image.flatten(1).T)
            to_weight.addmm_(to_planes, image.flatten(1).T)
        return to_x, to_weight, gradient.sum((0, 2, 3))


class PixelKernels(nn.Module):
    """The filter as a module; see `filtered`."""

    def __init__(self, factor: int, limit: float):
        super().__init__()
        self.factor, self.limit = factor, limit

    def forward(self, logits: Tensor, base: Tensor, guide: Tensor | None = None) -> Tensor:
        """See `filtered`."""
        return filtered(logits, base, self.factor, guide, self.limit)


def normed(layers: Sequence[Convolution], part: str) -> nn.Sequential:
    """Convolutions of a part with norms and ReLUs; 3 × 3 without bias."""
    modules: list[nn.Module] = []
    for layer in layers:
        if layer.part == part:
            size, outputs = layer.size, layer.outputs
            convolution = nn.Conv2d(layer.inputs, outputs, size, padding=size // 2, bias=size == 1)
            modules += [convolution, ChunkNorm(outputs), nn.ReLU(inplace=True)]
    return nn.Sequential(*modules)


def fold(block: nn.Sequential) -> None:
    """Fold a block's norms into the convolutions before them."""
    for number in reversed(range(1, len(block))):
        if isinstance(block[number], ChunkNorm):
            block[number - 1] = fuse_conv_bn_eval(block[number - 1].eval(), block[number].eval())
            del block[number]

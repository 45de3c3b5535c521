"""A perceptual distance of two visibilities: between features of a pretrained network.

After Datta et al. 2022 (3.3), who do not say which layers of VGG-19: here relu2_2, as the independent
implementation of Hu et al. 2025 has it. SqueezeNet 1.1 costs a fiftieth of it.
"""

from collections.abc import Sequence
from pathlib import Path

import torch
import torchvision
from torch import Tensor

from neural_shadows.networks.pretrained_trunk import MODELS, Net, read_trunk

# Where the features are taken: after so many layers of the trunk.
LAYERS: dict[Net, tuple[int, ...]] = {
    "squeeze": (2, 5),  # after the first ReLU, after fire3
    "vgg19": (9,),  # relu2_2
}
KEYS: dict[Net, str] = {"squeeze": "metrics.lpips.trunk", "vgg19": "perceptual.trunk"}

_MEAN, _DEVIATION = (0.485, 0.456, 0.406), (0.229, 0.224, 0.225)  # of ImageNet's pictures


class Perceptual:
    """Features of pictures by a pretrained trunk, and their distance.

    Args:
        net: `squeeze` or `vgg19`. trunk: file of its weights.
        dtype: what the trunk computes in.

    Raises:
        InputError: the trunk cannot be used; names the config's key.
    """

    def __init__(self, net: Net, trunk: Path, device: torch.device, dtype: torch.dtype):
        weights = read_trunk(net, trunk, KEYS[net])
        with torch.device("meta"):
            layers = torchvision.models.get_model(MODELS[net], weights=None).features
        layers.load_state_dict(weights, assign=True)
        layers = layers[: max(LAYERS[net])].to(device, dtype, memory_format=torch.channels_last)
        self._layers = layers.requires_grad_(False)
        self._taken = LAYERS[net]
        self._dtype = dtype
        mean, deviation = (torch.tensor(one, device=device) for one in (_MEAN, _DEVIATION))
        self._scale, self._shift = (1 / deviation).view(3, 1, 1), (-mean / deviation).view(3, 1, 1)

    def features(self, picture: Tensor) -> list[Tensor]:
        """Features of grey pictures (B, 1, H, W) in [0, 1]."""
        x = picture * self._scale + self._shift
        x = x.to(self._dtype).contiguous(memory_format=torch.channels_last)
        found = []
        for number, layer in enumerate(self._layers, 1):
            x = layer(x)
            if number in self._taken:
                found.append(x)
        return found

    @staticmethod
    def distance(one: Sequence[Tensor], other: Sequence[Tensor]) -> Tensor:
        """The mean squared differences of the layers, added; with gradients for the first alone."""
        return torch.stack([MeanSquare.apply(a, b) for a, b in zip(one, other)]).sum()


class MeanSquare(torch.autograd.Function):
    """Mean squared difference of two pictures, with a gradient for the first.

    That of torch's own operations comes in float32 and in another order of memory: 10 ms instead of 1
    of 127 × 127 × 64 values in bfloat16.
    """

    @staticmethod
    def forward(ctx, a: Tensor, b: Tensor) -> Tensor:
        """Of two (B, C, H, W), in float32."""
        difference = a - b
        ctx.save_for_backward(difference)
        norms = torch.linalg.vector_norm(difference, dim=1)  # no float32 of all of it
        return norms.float().square().sum() / difference.numel()

    @staticmethod
    def backward(ctx, gradient: Tensor) -> tuple[Tensor, None]:
        (difference,) = ctx.saved_tensors
        return difference * (2 / difference.numel() * gradient).to(difference.dtype), None

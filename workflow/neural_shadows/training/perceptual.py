"""Perceptual distance of visibilities: features of a pretrained backbone.

After Datta et al. 2022 (3.3), who do not specify layers of VGG-19: here relu2_2, as in the
independent implementation of Hu et al. 2025. SqueezeNet 1.1 costs a fiftieth of it.
"""

from collections.abc import Sequence
from pathlib import Path

import torch
from torch import Tensor

from neural_shadows.networks.pretrained_trunk import MODELS, Net, read_trunk

# Numbers of the backbone's layers with features.
LAYERS: dict[Net, tuple[int, ...]] = {
    "squeeze": (2, 5),  # after the first ReLU, after fire3
    "vgg19": (9,),  # relu2_2
}
KEYS: dict[Net, str] = {"squeeze": "metrics.lpips.trunk", "vgg19": "perceptual.trunk"}

_MEAN, _DEVIATION = (0.485, 0.456, 0.406), (0.229, 0.224, 0.225)  # of ImageNet's pictures


class Perceptual:
    """Features of pictures by a pretrained backbone, and their distance.

    Args:
        net: `squeeze` or `vgg19`. trunk: file of its weights.
        dtype: of the backbone.

    Raises:
        InputError: an unusable file; names the config's key.
    """

    def __init__(self, net: Net, trunk: Path, device: torch.device, dtype: torch.dtype):
        import torchvision  # loading takes 2.3 s, needless without this term

        weights = read_trunk(net, trunk, KEYS[net])
        with torch.device("meta"):
            layers = torchvision.models.get_model(MODELS[net], weights=None).features
        layers.load_state_dict(weights, assign=True)
        layers = layers[: max(LAYERS[net])].to(device, dtype, memory_format=torch.channels_last)
        self._layers = layers.requires_grad_(False)
        self._layer_numbers = LAYERS[net]
        self._dtype = dtype
        mean, deviation = (torch.tensor(x, device=device) for x in (_MEAN, _DEVIATION))
        self._scale, self._shift = (1 / deviation).view(3, 1, 1), (-mean / deviation).view(3, 1, 1)

    def features(self, picture: Tensor) -> list[Tensor]:
        """Features of grey pictures (B, 1, H, W) in [0, 1]."""
        x = picture * self._scale + self._shift
        x = x.to(self._dtype).contiguous(memory_format=torch.channels_last)
        features = []
        for number, layer in enumerate(self._layers, 1):
            x = layer(x)
            if number in self._layer_numbers:
                features.append(x)
        return features

    @staticmethod
    def distance(features: Sequence[Tensor], others: Sequence[Tensor]) -> Tensor:
        """Sum of the layers' mean squared differences; gradients for the first alone."""
        return torch.stack([MeanSquare.apply(a, b) for a, b in zip(features, others)]).sum()


class MeanSquare(torch.autograd.Function):
    """Mean squared difference of two pictures, differentiable by the first.

    torch's own gradient has float32 and another memory order: 10 ms instead of 1 for 127 × 127 × 64
    values in bfloat16.
    """

    @staticmethod
    def forward(ctx, a: Tensor, b: Tensor) -> Tensor:
        """Mean over (B, C, H, W), in float32."""
        difference = a - b
        ctx.save_for_backward(difference)
        norms = torch.linalg.vector_norm(difference, dim=1)  # without a float32 copy of all
        return norms.float().square().sum() / difference.numel()

    @staticmethod
    def backward(ctx, gradient: Tensor) -> tuple[Tensor, None]:
        (difference,) = ctx.saved_tensors
        return difference * (2 / difference.numel() * gradient).to(difference.dtype), None

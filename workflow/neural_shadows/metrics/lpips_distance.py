"""Image metrics of a frame against its reference, besides FLIP [4.1].

All images are grey display (sRGB) values: float32 arrays of shape (H, W) in [0, 1].
"""

import warnings
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from neural_shadows.metrics.grey_images import check_grey
from neural_shadows.metrics.lpips_trunk import Net, find_trunk

if TYPE_CHECKING:
    import torch

    Features = list[torch.Tensor]

_PIECE = 4096  # pixels; of 64 channels in float32: 1 MiB


class Lpips:
    """LPIPS 0.1 (Zhang et al. 2018), with the reference's features computed only once.

    `distance(image, features(reference))` is what `lpips.LPIPS(net=net)` gives for the
    pair; a view's `features(reference)` serve every method that is compared with it.
    """

    def __init__(self, net: Net, trunk: Path | None, device: str = "cpu") -> None:
        """Load the trunk from the file `trunk`, or as torchvision's file from torch's cache.

        That cache is `$TORCH_HOME/hub/checkpoints`, by default in `~/.cache/torch`; what is
        not in it is downloaded. The linear heads come with the package `lpips`.

        Raises:
            InputError: the trunk cannot be read or downloaded, or it is not `net`'s.
        """
        import lpips
        import torch

        weights = find_trunk(net, trunk, Path(torch.hub.get_dir()) / "checkpoints")
        with warnings.catch_warnings():
            # lpips 0.1.4 names torchvision's models in the manner of torchvision 0.12.
            warnings.filterwarnings("ignore", category=UserWarning, module="torchvision")
            model = lpips.LPIPS(net=net, version="0.1", pnet_rand=True, verbose=False)
        # lpips cuts the trunk in slices but keeps the layers' numbers: slice2.3.weight.
        model.net.load_state_dict(
            {key: weights[key.partition(".")[2]] for key in model.net.state_dict()}
        )
        # Channels last: the trunk is 1.8 times as fast, at the same values to 1e-8. In bfloat16
        # it is 2 to 3 times as fast again, but distances are up to 0.0014 off: not used.
        self._model = model.eval().to(device, memory_format=torch.channels_last)
        self._heads = [head.model[-1].weight.reshape(-1) for head in self._model.lins]
        self._device = device

    def features(self, image: np.ndarray) -> "Features":
        """The image's unit-length features of each layer: tensors (h w, C).

        Raises:
            ValueError: it is no grey image in [0, 1].
        """
        import torch

        check_grey(image)
        with torch.inference_mode():
            return [_unit(layer) for layer in self._layers(image)]

    def distance(self, image: np.ndarray, reference_features: "Features") -> float:
        """LPIPS distance (0 for identical frames) to the reference of these `features`.

        Raises:
            ValueError: it is no grey image in [0, 1].
        """
        import torch

        check_grey(image)
        total = 0.0
        with torch.inference_mode():
            for layer, reference, head in zip(
                self._layers(image), reference_features, self._heads, strict=True
            ):
                # In pieces that stay in the cache: 22 ms instead of 136 for 1200 x 800.
                pieces = zip(layer.split(_PIECE), reference.split(_PIECE), strict=True)
                weighted = [((_unit(a) - b).square_() @ head).sum() for a, b in pieces]
                total += float(torch.stack(weighted).sum()) / len(layer)
        return total

    def _layers(self, image: np.ndarray) -> "Features":
        """The trunk's features as they come: tensors (h w, C)."""
        import torch

        grey = 2 * torch.tensor(image, dtype=torch.float32, device=self._device) - 1
        rgb = self._model.scaling_layer(grey.expand(1, 3, *grey.shape))
        layers = self._model.net(rgb.contiguous(memory_format=torch.channels_last))
        return [layer[0].permute(1, 2, 0).flatten(0, 1) for layer in layers]


def _unit(features: "torch.Tensor") -> "torch.Tensor":
    """Rows scaled to length 1; lpips's own epsilon for rows of zeros."""
    import torch

    return torch.nn.functional.normalize(features, dim=1, eps=1e-10)

"""Image metrics of a frame against its reference, besides FLIP [4.1].

All images are grey display (sRGB) values: float32 arrays of shape (H, W) in [0, 1].
"""

import warnings
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from skimage.metrics import structural_similarity

from neural_shadows.grey_images import check_grey
from neural_shadows.lpips_trunk import Net, find_trunk

if TYPE_CHECKING:
    import torch

    Features = list[torch.Tensor]


def psnr(image: np.ndarray, reference: np.ndarray) -> float:
    """Peak signal-to-noise ratio in dB for peak 1, at most 100 (identical frames).

    Raises:
        ValueError: the images are no pair of grey images in [0, 1].
    """
    _check_pair(image, reference)
    mean_square = np.mean(np.square(image - reference, dtype=np.float64))
    return float(-10 * np.log10(max(mean_square, 1e-10)))  # 1e-10 is 100 dB


def ssim(image: np.ndarray, reference: np.ndarray) -> float:
    """Mean structural similarity (Wang et al. 2004: Gaussian window of sigma 1.5, range 1).

    Raises:
        ValueError: the images are no pair of grey images in [0, 1], or have a side
            shorter than the window's 11 pixels.
    """
    _check_pair(image, reference)
    return float(
        structural_similarity(
            image,
            reference,
            gaussian_weights=True,
            sigma=1.5,
            use_sample_covariance=False,
            data_range=1.0,
        )
    )


_PIECE = 4096  # pixels; of 64 channels in float32: 1 MiB


class ShadowError(NamedTuple):
    """Shares, in [0, 1], of the object and receiver pixels whose visibility is wrong."""

    false_shadow: float
    """Dark where the reference is lit."""
    light_leak: float
    """Lit where the reference is dark."""
    total: float


def shadow_error(
    lit: np.ndarray, reference_lit: np.ndarray, shaded_mask: np.ndarray
) -> ShadowError:
    """Share of wrong visibility among the pixels that show object or receiver.

    `lit`, `reference_lit` and `shaded_mask` are bool arrays of one shape (H, W); the
    mask is true where object or receiver is seen.

    Raises:
        ValueError: the mask is empty.
    """
    shaded = np.count_nonzero(shaded_mask)
    if shaded == 0:
        raise ValueError("shadow_error: no pixel shows object or receiver")
    wrong = shaded_mask & (lit != reference_lit)
    total = np.count_nonzero(wrong)
    false_shadow = np.count_nonzero(wrong & reference_lit)
    return ShadowError(false_shadow / shaded, (total - false_shadow) / shaded, total / shaded)


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


def _check_pair(image: np.ndarray, reference: np.ndarray) -> None:
    check_grey(reference)
    check_grey(image, reference.shape)

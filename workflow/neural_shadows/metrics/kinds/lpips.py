"""LPIPS of grey frames (Zhang et al. 2018), by the package `lpips`."""

import warnings
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from neural_shadows.metrics.grey_images import check_pair
from neural_shadows.metrics.metric import Metric

if TYPE_CHECKING:
    import lpips
    import torch

    from neural_shadows.networks.pretrained_trunk import Net

METRICS = {"lpips": Metric("LPIPS", slow=True, comparable=False)}
Lpips = Callable[[np.ndarray, np.ndarray], float]
"""Distance of a grey image (H, W) in [0, 1] to its reference; 0 for identical ones."""


def with_backbone(net: "Net", trunk: Path | None) -> Callable[..., dict[str, float]]:
    distance = make_lpips(net, trunk)
    return lambda image, reference: {"lpips": distance(image, reference)}


def load_model(net: "Net", trunk: Path | None) -> "lpips.LPIPS":
    """LPIPS 0.1 with a backbone from a file or torch's cache. Without a file, torchvision's.

    That cache is `$TORCH_HOME/hub/checkpoints`, by default in `~/.cache/torch`; what is not in it
    is downloaded. The package has the linear heads.

    Raises:
        InputError: the file `trunk` cannot be used.
        OSError, RuntimeError: torchvision's cannot be downloaded, or is damaged.
    """
    import lpips

    from neural_shadows.networks.pretrained_trunk import read_trunk

    with warnings.catch_warnings():
        # lpips 0.1.4 names torchvision's models in the manner of torchvision 0.12.
        warnings.filterwarnings("ignore", category=UserWarning, module="torchvision")
        model = lpips.LPIPS(net=net, version="0.1", pnet_rand=trunk is not None, verbose=False)
    if trunk:
        weights = read_trunk(net, trunk)
        # lpips cuts the backbone into slices but keeps the layers' numbers: slice2.3.weight.
        slices = {key: weights[key.partition(".")[2]] for key in model.net.state_dict()}
        model.net.load_state_dict(slices)
    return model.eval()


def make_lpips(net: "Net", trunk: Path | None) -> Lpips:
    """LPIPS of grey frames. Arguments and errors as of `load_model`."""
    import torch

    # Channels last: the backbone is 1.8 times as fast, at the same values to 1e-8.
    model = load_model(net, trunk).to(memory_format=torch.channels_last)

    def rgb(image: np.ndarray) -> "torch.Tensor":
        grey = torch.tensor(image, dtype=torch.float32)
        return grey.expand(1, 3, *grey.shape).contiguous(memory_format=torch.channels_last)

    def distance(image: np.ndarray, reference: np.ndarray) -> float:
        check_pair(image, reference)
        with torch.inference_mode():
            return float(model(rgb(image), rgb(reference), normalize=True))

    return distance

"""The user's own file of the pretrained convolution layers ("trunk") of a perceptual measure."""

from pathlib import Path
from typing import Literal

import torch
import torchvision

from neural_shadows.errors import InputError

Net = Literal["alex", "squeeze", "vgg", "vgg19"]

# torchvision's ImageNet classifiers, of which LPIPS (all but the last) and the perceptual loss of
# screen-space networks (`squeeze`, `vgg19`) use the `features`.
MODELS: dict[Net, str] = {
    "alex": "alexnet",
    "squeeze": "squeezenet1_1",
    "vgg": "vgg16",
    "vgg19": "vgg19",
}

_LPIPS = "metrics.lpips.trunk"


def read_trunk(net: Net, path: Path, key: str = _LPIPS) -> dict[str, torch.Tensor]:
    """State dict of the `features` of `net`'s classifier (keys `0.weight`, …).

    The file may hold the whole classifier (keys `features.0.weight`, …), as torchvision
    publishes it, or only its features. Nothing in it is run.

    Args:
        key: of the configuration, where the path stands.

    Raises:
        InputError: it cannot be read, or is not of this classifier.
    """
    model = MODELS[net]
    with torch.device("meta"):  # shapes only: VGG16's weights would take half a gigabyte
        features = torchvision.models.get_model(model, weights=None).features
    try:
        state = torch.load(path, map_location="cpu", weights_only=True)
        state = {key.removeprefix("features."): value for key, value in state.items()}
        features.load_state_dict({key: state[key] for key in features.state_dict()}, assign=True)
        weights = features.state_dict()
        why = None
        if not all(one.is_floating_point() and one.isfinite().all() for one in weights.values()):
            why = "it holds numbers that are not finite or not real"
    except OSError as error:
        why = error.strerror or str(error)
    except Exception:  # what is no file of weights makes the restricted unpickler raise anything
        why = f"it is no whole PyTorch file of {model}'s plain weights"
    if why:
        use, of_net = (
            ("LPIPS", f" and metrics.lpips.net to {net!r}") if key == _LPIPS else (net, "")
        )
        raise InputError(
            f"{use} trunk {path.name} cannot be used: {why}; set the config key {key} to "
            f"torchvision's weights of {model}{of_net}"
        )
    return weights

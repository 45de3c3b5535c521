"""The user's own file of the pretrained convolution layers ("trunk") inside LPIPS."""

from pathlib import Path
from typing import Any, Literal

import torch
import torchvision

from neural_shadows.errors import InputError

Net = Literal["alex", "squeeze", "vgg"]

# torchvision's ImageNet classifiers, of which LPIPS uses the `features`.
MODELS: dict[Net, str] = {"alex": "alexnet", "squeeze": "squeezenet1_1", "vgg": "vgg16"}


def read_trunk(net: Net, path: Path) -> dict[str, torch.Tensor]:
    """State dict of the `features` of `net`'s classifier (keys `0.weight`, …).

    The file may hold the whole classifier (keys `features.0.weight`, …), as torchvision
    publishes it, or only its features. Nothing in it is run.

    Raises:
        InputError: it cannot be read, or is not of this classifier.
    """
    try:
        state: Any = torch.load(path, map_location="cpu", weights_only=True)
    except OSError as error:
        raise _unusable(net, path, error.strerror or str(error)) from error
    except Exception as error:
        # What is not a weights file makes the restricted unpickler raise nearly anything.
        raise _unusable(net, path, "it is not a whole PyTorch file of plain weights") from error
    if not isinstance(state, dict):
        raise _unusable(net, path, f"it holds one {type(state).__name__} and no state dict")
    state = {str(key).removeprefix("features."): value for key, value in state.items()}
    with torch.device("meta"):  # shapes only: VGG16's weights would take half a gigabyte
        model = torchvision.models.get_model(MODELS[net], weights=None)
    weights = {}
    for key, expected in model.features.state_dict().items():
        weights[key] = value = state.get(key)
        found = tuple(value.shape) if isinstance(value, torch.Tensor) else "missing"
        if found != tuple(expected.shape):
            why = f"its tensor {key!r} is {found}, that of {MODELS[net]} {tuple(expected.shape)}"
            raise _unusable(net, path, why)
        if not (value.is_floating_point() and bool(value.isfinite().all())):
            raise _unusable(net, path, f"its tensor {key!r} is not of finite real numbers")
    return weights


def _unusable(net: Net, path: Path, why: str) -> InputError:
    return InputError(
        f"LPIPS trunk {path.name} cannot be used: {why}; set the config key metrics.lpips.trunk "
        f"to torchvision's weights of {MODELS[net]} and metrics.lpips.net to {net!r}"
    )

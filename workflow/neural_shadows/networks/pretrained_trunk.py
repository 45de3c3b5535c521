"""The user's file of a perceptual metric's pretrained backbone."""

from pathlib import Path
from typing import Literal

import torch

from neural_shadows.errors import InputError

Net = Literal["alex", "squeeze", "vgg", "vgg19"]

# torchvision's ImageNet classifiers. LPIPS uses the `features` of all but the last, the perceptual
# loss of screen-space networks those of `squeeze` and `vgg19`.
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
    publishes it, or only its features. Nothing in it is executed.

    Args:
        key: of the path in the configuration.

    Raises:
        InputError: an unreadable file, or of another classifier.
    """
    import torchvision  # loading takes 2.3 s, needless in trainings without a trunk

    model = MODELS[net]
    with torch.device("meta"):  # shapes only: VGG16's weights would take half a gigabyte
        features = torchvision.models.get_model(model, weights=None).features
    try:
        state = torch.load(path, map_location="cpu", weights_only=True)
        state = {name.removeprefix("features."): value for name, value in state.items()}
        features.load_state_dict({name: state[name] for name in features.state_dict()}, assign=True)
        weights = features.state_dict()
        problem = None
        if not all(each.is_floating_point() and each.isfinite().all() for each in weights.values()):
            problem = "numbers that are not finite or not real"
    except OSError as error:
        problem = error.strerror or str(error)
    except Exception:  # the restricted unpickler raises anything on other files
        problem = f"not a whole PyTorch file of {model}'s plain weights"
    if problem:
        use, of_net = (
            ("LPIPS", f" and metrics.lpips.net to {net!r}") if key == _LPIPS else (net, "")
        )
        raise InputError(
            f"{key}: {path.name}: unusable as {use} backbone: {problem}. Set {key} to torchvision's "
            f"weights of {model}{of_net}."
        )
    return weights

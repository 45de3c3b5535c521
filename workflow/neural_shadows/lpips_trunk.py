"""The pretrained convolution layers ("trunk") inside LPIPS: found, fetched, checked."""

from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

from neural_shadows.download import fetch
from neural_shadows.errors import InputError

if TYPE_CHECKING:
    import torch

Net = Literal["alex", "squeeze", "vgg"]

# VGG16's file, the largest of the three, has 553 MB.
MAX_BYTES = 600_000_000


class Trunk(NamedTuple):
    """One of torchvision's ImageNet classifiers, of which LPIPS uses the `features` part."""

    model: str
    """Name in torchvision's registry of models."""
    url: str
    """The official weights; the digits before `.pth` begin the file's SHA-256."""

    @property
    def file(self) -> str:
        return self.url.rpartition("/")[2]

    @property
    def sha256(self) -> str:
        return self.file.removesuffix(".pth").rpartition("-")[2]


TRUNKS: dict[Net, Trunk] = {
    "alex": Trunk("alexnet", "https://download.pytorch.org/models/alexnet-owt-7be5be79.pth"),
    "squeeze": Trunk(
        "squeezenet1_1", "https://download.pytorch.org/models/squeezenet1_1-b8a52dc0.pth"
    ),
    "vgg": Trunk("vgg16", "https://download.pytorch.org/models/vgg16-397923af.pth"),
}


def find_trunk(net: Net, trunk: Path | None, cache: Path) -> "dict[str, torch.Tensor]":
    """State dict of the `features` part of `net`'s classifier (keys `0.weight`, ...).

    It comes from the user's file `trunk` if one is given, which may hold the whole
    classifier (keys `features.0.weight`, ...) or only its features; else from torchvision's
    file in the folder `cache`, which is downloaded there if it is not there yet.

    Raises:
        InputError: the trunk cannot be read or downloaded, or it is not `net`'s.
    """
    path = trunk
    if path is None:
        path = cache / TRUNKS[net].file
        if not path.exists():
            _download(net, path)
    state = _read(net, path)
    shapes = _shapes(net)
    for key, shape in shapes.items():
        if key not in state:
            raise _unusable(net, path, f"it has no tensor {key!r} of {TRUNKS[net].model}")
        found = tuple(state[key].shape)
        if found != shape:
            raise _unusable(
                net,
                path,
                f"its tensor {key!r} has shape {found}, that of {TRUNKS[net].model} {shape}",
            )
    return {key: state[key] for key in shapes}


def _download(net: Net, path: Path) -> None:
    trunk = TRUNKS[net]
    try:
        fetch(
            trunk.url,
            path,
            sha256=trunk.sha256,
            max_bytes=MAX_BYTES,
            remedy=_remedy(net),
            label=trunk.file,
        )
    except OSError as error:  # the folder, often in a home that compute nodes may not write
        raise _unusable(net, path, f"cannot write it: {error.strerror or error}") from error


def _read(net: Net, path: Path) -> "dict[str, torch.Tensor]":
    """The file's tensors, `features.` taken off their names."""
    import torch

    try:
        state: Any = torch.load(path, map_location="cpu", weights_only=True)
    except OSError as error:
        raise _unusable(net, path, error.strerror or str(error)) from error
    except Exception as error:
        # What is not a weights file makes the restricted unpickler raise nearly anything.
        raise _unusable(net, path, "it is not a whole PyTorch file of plain weights") from error
    if not isinstance(state, dict):
        raise _unusable(net, path, f"it holds one {type(state).__name__} and no state dict")
    return {
        str(key).removeprefix("features."): value
        for key, value in state.items()
        if isinstance(value, torch.Tensor)
    }


def _shapes(net: Net) -> dict[str, tuple[int, ...]]:
    """Shape of each weight of `net`'s features."""
    import torch
    import torchvision

    with torch.device("meta"):  # shapes only: VGG16's weights would take half a gigabyte
        model = torchvision.models.get_model(TRUNKS[net].model, weights=None)
    return {key: tuple(weight.shape) for key, weight in model.features.state_dict().items()}


def _unusable(net: Net, path: Path, why: str) -> InputError:
    return InputError(f"LPIPS trunk {path} cannot be used: {why}; {_remedy(net)}")


def _remedy(net: Net) -> str:
    return (
        f"for LPIPS, set the config key metrics.lpips.trunk to a local copy of "
        f"{TRUNKS[net].file} (from {TRUNKS[net].url}) and metrics.lpips.net to {net!r}"
    )

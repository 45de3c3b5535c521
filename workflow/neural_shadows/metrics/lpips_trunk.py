"""The pretrained convolution layers ("trunk") inside LPIPS: found, fetched, checked."""

import zipfile
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

from neural_shadows.errors import InputError
from neural_shadows.files.download import fetch

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
    """The official weights."""
    sha256: str
    """Of that file, in hexadecimal; its name has the first eight digits."""

    @property
    def file(self) -> str:
        return self.url.rpartition("/")[2]


TRUNKS: dict[Net, Trunk] = {
    "alex": Trunk(
        "alexnet",
        "https://download.pytorch.org/models/alexnet-owt-7be5be79.pth",
        "7be5be791159472b1fbf3c69796f7cb30dca7ad8466c2df70058c37116cdee02",
    ),
    "squeeze": Trunk(
        "squeezenet1_1",
        "https://download.pytorch.org/models/squeezenet1_1-b8a52dc0.pth",
        "b8a52dc049b60e4b6ab68ad0df457362afab8b6304b2febdc1650a5dab4d7e7b",
    ),
    "vgg": Trunk(
        "vgg16",
        "https://download.pytorch.org/models/vgg16-397923af.pth",
        "397923af8e79cdbb6a7127f12361acd7a2f83e06b05044ddf496e83de57a5bf0",
    ),
}


def find_trunk(net: Net, trunk: Path | None, cache: Path) -> "dict[str, torch.Tensor]":
    """State dict of the `features` part of `net`'s classifier (keys `0.weight`, ...).

    It comes from the user's file `trunk` if one is given, which may hold the whole
    classifier (keys `features.0.weight`, ...) or only its features; else from torchvision's
    file in the folder `cache`, which is downloaded there if it is not there, or another one.

    Raises:
        InputError: the trunk cannot be read or downloaded, or it is not `net`'s.
    """
    path, name = trunk, str(trunk)
    if path is None:
        path = cache / TRUNKS[net].file
        # Without its folder, for reports say why LPIPS is missing, and are shown to others.
        name = f"{path.name} in torch's cache"
        _download(net, path, name)
    state = _read(net, path, name)
    shapes = _shapes(net)
    for key, shape in shapes.items():
        if key not in state:
            raise _unusable(net, name, f"it has no tensor {key!r} of {TRUNKS[net].model}")
        found = tuple(state[key].shape)
        if found != shape:
            raise _unusable(
                net,
                name,
                f"its tensor {key!r} has shape {found}, that of {TRUNKS[net].model} {shape}",
            )
        if not _is_plain(state[key]):
            raise _unusable(net, name, f"its tensor {key!r} is not of finite real numbers in full")
    return {key: state[key] for key in shapes}


def _download(net: Net, path: Path, name: str) -> None:
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
        raise _unusable(net, name, f"cannot write it: {error.strerror}") from error


def _read(net: Net, path: Path, name: str) -> "dict[str, torch.Tensor]":
    """The file's tensors, `features.` taken off their names."""
    import torch

    try:
        if zipfile.is_zipfile(path):
            with zipfile.ZipFile(path) as archive:
                # PyTorch compresses nothing, and what it did not write may unpack to anything.
                if any(member.compress_type for member in archive.infolist()):
                    raise ValueError("compressed")
        state: Any = torch.load(path, map_location="cpu", weights_only=True)
    except OSError as error:
        raise _unusable(net, name, error.strerror or str(error)) from error
    except Exception as error:
        # What is not a weights file makes the restricted unpickler raise nearly anything.
        raise _unusable(net, name, "it is not a whole PyTorch file of plain weights") from error
    if not isinstance(state, dict):
        raise _unusable(net, name, f"it holds one {type(state).__name__} and no state dict")
    return {
        str(key).removeprefix("features."): value
        for key, value in state.items()
        if isinstance(value, torch.Tensor)
    }


def _is_plain(weights: "torch.Tensor") -> bool:
    """Whether these are finite floating-point numbers, each stored."""
    import torch

    return (
        weights.is_floating_point()
        and weights.layout == torch.strided
        and not weights.is_meta
        and bool(weights.isfinite().all())
    )


def _shapes(net: Net) -> dict[str, tuple[int, ...]]:
    """Shape of each weight of `net`'s features."""
    import torch
    import torchvision

    with torch.device("meta"):  # shapes only: VGG16's weights would take half a gigabyte
        model = torchvision.models.get_model(TRUNKS[net].model, weights=None)
    return {key: tuple(weight.shape) for key, weight in model.features.state_dict().items()}


def _unusable(net: Net, name: str, why: str) -> InputError:
    return InputError(f"LPIPS trunk {name} cannot be used: {why}; {_remedy(net)}")


def _remedy(net: Net) -> str:
    return (
        f"for LPIPS, set the config key metrics.lpips.trunk to a local copy of "
        f"{TRUNKS[net].file} (from {TRUNKS[net].url}) and metrics.lpips.net to {net!r}"
    )

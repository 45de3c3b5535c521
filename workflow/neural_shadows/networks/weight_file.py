"""Weight files: safetensors with the model configuration in the header."""

import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, TypeVar

import torch
from safetensors import SafetensorError, safe_open
from safetensors.torch import save

from neural_shadows.errors import InputError
from neural_shadows.files.whole_files import whole_file
from neural_shadows.networks.kinds import make_network
from neural_shadows.networks.object_space.shadow_network import ShadowNetwork
from neural_shadows.networks.settings.networks import ray_network
from neural_shadows.settings.records import WeightsHeader

Network = TypeVar("Network")


def save_tensors(
    path: Path, tensors: Mapping[str, torch.Tensor], header: Mapping[str, Any]
) -> None:
    """Write tensors and a JSON header as safetensors, atomically."""
    with whole_file(path) as part:
        content = save(
            {name: tensor.detach().cpu().contiguous() for name, tensor in tensors.items()},
            metadata={"header": json.dumps(header, sort_keys=True)},
        )
        # Not by safetensors' own writer, whose error on a full disk is no OSError.
        part.write_bytes(content)


def load_tensors(path: Path) -> tuple[dict[str, torch.Tensor], dict[str, Any]]:
    """Read tensors and header from a file of `save_tensors`.

    Raises:
        InputError: a damaged or foreign file.
    """
    try:
        with safe_open(path, framework="pt") as file:
            header = json.loads((file.metadata() or {})["header"])
            return {name: file.get_tensor(name) for name in file.keys()}, header
    except (SafetensorError, KeyError, ValueError) as error:
        raise InputError(
            f"{path}: damaged, or not of this pipeline ({error}). Delete it and run again."
        ) from error


def save_network(path: Path, network: ShadowNetwork, header: WeightsHeader) -> None:
    """Write a network; `header["network"]` holds its settings."""
    save_tensors(path, network.stored(), header)


def load_network(path: Path) -> tuple[ShadowNetwork, dict[str, Any]]:
    """Read a network and its header; see `load_fitting`."""

    def build(header: dict[str, Any], tensors: dict[str, torch.Tensor]) -> ShadowNetwork:
        network = make_network(ray_network(header["network"]))
        network.restore(tensors)
        if header.get("training") is not None:
            network.pushes = (0.0,)  # the training has placed the surface
        return network

    return load_fitting(path, build)


def load_fitting(
    path: Path, build: Callable[[dict[str, Any], dict[str, torch.Tensor]], Network]
) -> tuple[Network, dict[str, Any]]:
    """Read a network, built from header and tensors, and its header.

    Raises:
        InputError: as `load_tensors`; or weights that do not fit the header's configuration.
    """
    tensors, header = load_tensors(path)
    try:
        return build(header, tensors), header
    except Exception as error:  # coded tensors raise errors of many types
        reason = " ".join(str(error).split())[:200]
        raise InputError(
            f"{path}: weights do not fit the header ({reason}). Delete it and train again."
        ) from error

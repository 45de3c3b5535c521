"""Trained networks on disk: safetensors with the whole model configuration in the header."""

import json
from pathlib import Path
from typing import Any

import torch
from safetensors import SafetensorError, safe_open
from safetensors.torch import save

from neural_shadows.errors import InputError
from neural_shadows.files.broken import reading
from neural_shadows.files.whole_files import whole_file
from neural_shadows.networks.kinds import make_network
from neural_shadows.networks.object_space.shadow_network import ShadowNetwork

# The largest number among the settings that a config may have: of entries of a hash table.
MOST = 2**24


def save_tensors(path: Path, tensors: dict[str, torch.Tensor], header: dict) -> None:
    """Write tensors and a JSON header as safetensors, whole or not at all.

    Raises:
        OSError: the folder cannot be written, or the disk is full.
    """
    with whole_file(path) as part:
        content = save(
            {name: tensor.detach().cpu().contiguous() for name, tensor in tensors.items()},
            metadata={"header": json.dumps(header, sort_keys=True)},
        )
        # Not by safetensors' own writer, whose error on a full disk is no OSError.
        part.write_bytes(content)


def load_tensors(path: Path) -> tuple[dict[str, torch.Tensor], dict]:
    """Read what `save_tensors` wrote.

    Raises:
        InputError: the file is missing or cannot be read; or it is truncated or not of this
            pipeline, and moved aside.
    """
    with reading(path, "file of this pipeline", SafetensorError, KeyError, RecursionError):
        if not Path(path).is_file():  # a folder's error would speak of a device
            raise FileNotFoundError
        with safe_open(path, framework="pt") as file:
            header = json.loads((file.metadata() or {})["header"])
            return {name: file.get_tensor(name) for name in file.keys()}, header


def save_network(path: Path, network: ShadowNetwork, header: dict) -> None:
    """Write a network; `header["network"]` must hold what `make_network` makes it from."""
    save_tensors(path, network.stored(), header)


def load_network(path: Path) -> tuple[ShadowNetwork, dict]:
    """Read a network and the header it was saved with.

    Raises:
        InputError: the file is missing, truncated, not of this pipeline, or its weights do
            not fit the configuration in its header.
    """
    tensors, header = load_tensors(path)
    try:
        _check_settings(header["network"], tensors)
        network = make_network(header["network"])
        network.restore(tensors)
    except (KeyError, TypeError, ValueError, OverflowError, RuntimeError, MemoryError) as error:
        reason = " ".join(str(error).split())[:200]
        raise InputError(
            f"{path}: weights do not fit the header ({reason}); delete it and train again"
        ) from error
    return network, header


def _check_settings(settings: dict[str, Any], tensors: dict[str, torch.Tensor]) -> None:
    """Refuse settings of any size before something of that size is made."""
    for key, value in dict(settings).items():
        values = value if isinstance(value, list) else [value]
        layers = value if key == "hidden_layers" else len(values)
        if isinstance(layers, int) and layers > len(tensors):
            raise ValueError(f"{key}: there are only {len(tensors)} tensors")
        for number in values:
            if isinstance(number, int) and number > MOST:
                raise ValueError(f"{key}: {str(number)[:20]} is more than {MOST:,}")

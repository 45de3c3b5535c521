"""Networks of whole frames: built from settings, written, read."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import torch

from neural_shadows.errors import InputError
from neural_shadows.networks.screen_space.screen_forms import form_of
from neural_shadows.networks.screen_space.screen_network import ScreenNetwork
from neural_shadows.networks.weight_file import load_tensors, save_tensors

STORED = torch.float16


def make_screen_network(settings: Mapping[str, Any]) -> ScreenNetwork:
    """A network from an entry of the config's `screen_networks`.

    Raises:
        KeyError, TypeError, ValueError: an argument is missing, unknown or wrong.
    """
    return form_of(settings).network(settings)


def save_screen_network(path: Path, network: ScreenNetwork, header: Mapping[str, Any]) -> None:
    """Write a network's weights in 16 bits; `header["network"]` must hold its settings."""
    tensors = {name: weight.to(STORED) for name, weight in network.state_dict().items()}
    save_tensors(path, tensors, header)


def load_screen_network(path: Path) -> tuple[ScreenNetwork, dict[str, Any]]:
    """Read a network, in float32, and the header that it was saved with.

    Raises:
        InputError: the file is damaged, or its weights are not of the widths in its header.
    """
    tensors, header = load_tensors(path)
    try:
        network = make_screen_network(header["network"])
        network.load_state_dict({name: weight.float() for name, weight in tensors.items()})
    except (KeyError, TypeError, ValueError, RuntimeError) as error:
        reason = " ".join(str(error).split())[:200]
        raise InputError(
            f"{path}: its weights do not fit the settings in its header ({reason}); delete it and "
            "train again"
        ) from error
    return network, header

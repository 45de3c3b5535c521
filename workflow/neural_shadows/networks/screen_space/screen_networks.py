"""Screen-space networks: built from settings, written, read."""

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
    """Build a network from an entry of the config's `screen_networks`.

    Raises:
        KeyError, TypeError, ValueError: a missing, unknown or wrong argument.
    """
    return form_of(settings).network(settings)


def save_screen_network(path: Path, network: ScreenNetwork, header: Mapping[str, Any]) -> None:
    """Write weights in 16 bits; `header["network"]` holds the settings."""
    tensors = {name: weight.to(STORED) for name, weight in network.state_dict().items()}
    save_tensors(path, tensors, header)


def load_screen_network(path: Path) -> tuple[ScreenNetwork, dict[str, Any]]:
    """Read a network in float32, and its header.

    Raises:
        InputError: a damaged file, or weights of other widths than its header's.
    """
    tensors, header = load_tensors(path)
    try:
        network = make_screen_network(header["network"])
        network.load_state_dict({name: weight.float() for name, weight in tensors.items()})
    except (KeyError, TypeError, ValueError, RuntimeError) as error:
        reason = " ".join(str(error).split())[:200]
        raise InputError(
            f"{path}: weights do not fit the header ({reason}). Delete it and train again."
        ) from error
    return network, header

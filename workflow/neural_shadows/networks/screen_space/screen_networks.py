"""Screen-space networks: built from settings, written, read."""

from pathlib import Path
from typing import Any

import torch

from neural_shadows.networks.screen_space.screen_forms import form_of
from neural_shadows.networks.screen_space.screen_network import ScreenNetwork
from neural_shadows.networks.settings.networks import screen_network
from neural_shadows.networks.settings.screen_space import AnyScreenNetwork
from neural_shadows.networks.weight_file import load_fitting, save_tensors
from neural_shadows.settings.records import WeightsHeader

STORED = torch.float16


def make_screen_network(settings: AnyScreenNetwork) -> ScreenNetwork:
    """Build a network from its settings."""
    return form_of(settings).network(settings)


def save_screen_network(path: Path, network: ScreenNetwork, header: WeightsHeader) -> None:
    """Write weights in 16 bits; `header["network"]` holds the settings."""
    tensors = {name: weight.to(STORED) for name, weight in network.state_dict().items()}
    save_tensors(path, tensors, header)


def load_screen_network(path: Path) -> tuple[ScreenNetwork, dict[str, Any]]:
    """Read a network in float32, and its header; see `load_fitting`."""

    def build(header: dict[str, Any], tensors: dict[str, torch.Tensor]) -> ScreenNetwork:
        network = make_screen_network(screen_network(header["network"]))
        network.load_state_dict({name: weight.float() for name, weight in tensors.items()})
        return network

    return load_fitting(path, build)

"""Networks from plain data, as in a weight file's header; laid out by a mesh, and from their files."""

from pathlib import Path
from typing import Any

import trimesh

from neural_shadows.networks import kinds
from neural_shadows.networks.object_space.shadow_network import ShadowNetwork
from neural_shadows.networks.screen_space import screen_forms, screen_networks
from neural_shadows.networks.screen_space.screen_network import ScreenNetwork
from neural_shadows.networks.screen_space.widths import Convolution
from neural_shadows.networks.settings.networks import ray_network, screen_network
from neural_shadows.networks.weight_file import load_network, save_network

# Small networks of three encodings.
SMALL_FREQUENCY = {"encoding": "frequency", "frequencies": 3, "width": 64, "hidden_layers": 2}
SMALL_FIELD = {
    "encoding": "occupancy_field",
    "resolution": 16,
    "surface": "solid",
    "stored": "int8",
}
SMALL_GRIDS = {
    "encoding": "hash_grid",
    "points": 2,
    "grids": [4, 8],
    "channels": 2,
    "width": 8,
    "hidden_layers": 1,
    "head": "depth_confidence",
    "stored": "float32",
    "occupancy": 8,
    "table_size": 64,
}


def make_network(settings: dict[str, Any]) -> ShadowNetwork:
    """A network on rays."""
    return kinds.make_network(ray_network(settings))


def make_screen_network(settings: dict[str, Any]) -> ScreenNetwork:
    """A screen-space network."""
    return screen_networks.make_screen_network(screen_network(settings))


def layers_of(settings: dict[str, Any]) -> list[Convolution]:
    """A screen-space network's convolutions."""
    return screen_forms.layers_of(screen_network(settings))


def laid_out(shape: trimesh.Trimesh, folder: Path, settings: dict[str, Any]) -> ShadowNetwork:
    """A network as it is before a training."""
    shape.export(folder / "mesh.ply")
    network = make_network(settings)
    network.prepare(folder / "mesh.ply")
    network.initialise(1)
    return network


def reloaded(network: ShadowNetwork, folder: Path, settings: dict[str, Any]) -> ShadowNetwork:
    """The network that its file gives."""
    save_network(folder / "weights.safetensors", network, {"network": settings})
    return load_network(folder / "weights.safetensors")[0]

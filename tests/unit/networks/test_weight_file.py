"""Weight files: exact round trips, and refusal of other files."""

import pickle
from pathlib import Path

import pytest
import torch

from neural_shadows.errors import InputError
from neural_shadows.networks.object_space.frequency_network import FrequencyNetwork
from neural_shadows.networks.weight_file import load_network, save_network

SETTINGS = {"encoding": "frequency", "frequencies": 2, "width": 8, "hidden_layers": 2}
HEADER = {"name": "dragon", "network": SETTINGS, "training": {"learning_rate": 0.1}}


@pytest.fixture
def network() -> FrequencyNetwork:
    network = FrequencyNetwork(frequencies=2, width=8, hidden_layers=2)
    network.initialise(3)
    return network


def test_round_trip(tmp_path, network):
    first = tmp_path / "a" / "first.safetensors"
    save_network(first, network, HEADER)
    loaded, header = load_network(first)
    assert header == HEADER
    for ours, theirs in zip(network.parameters(), loaded.parameters(), strict=True):
        assert torch.equal(ours, theirs)


class Bomb:
    """Unpickling this makes a file."""

    def __init__(self, path: Path):
        self.path = path

    def __reduce__(self):
        return Path.touch, (self.path,)


@pytest.mark.parametrize("content", [0, 100, -1, pickle.dump, torch.save])
def test_truncated_files_and_pickles_are_refused(tmp_path, network, content):
    path, exploded = tmp_path / "weights.safetensors", tmp_path / "exploded"
    if callable(content):
        with path.open("wb") as file:
            content(Bomb(exploded), file)
    else:
        save_network(path, network, HEADER)
        path.write_bytes(path.read_bytes()[:content])
    with pytest.raises(InputError, match=r"weights.safetensors: damaged.*Delete it and run again"):
        load_network(path)
    assert not exploded.exists()


@pytest.mark.parametrize(
    ("settings", "reason"),
    [
        (SETTINGS | {"width": 16}, "size mismatch"),
        (SETTINGS | {"bias": True}, "bias"),
        (SETTINGS | {"encoding": "../../evil"}, "evil"),
    ],
)
def test_weights_unfit_for_the_header_are_refused(tmp_path, network, settings, reason):
    path = tmp_path / "weights.safetensors"
    save_network(path, network, HEADER | {"network": settings})
    with pytest.raises(InputError, match=f"weights.safetensors: .*do not fit the header.*{reason}"):
        load_network(path)

"""Weight files of screen-space networks."""

import pytest
import torch
from built_networks import make_screen_network
from safetensors import safe_open

from neural_shadows.errors import InputError
from neural_shadows.networks.screen_space.screen_networks import (
    load_screen_network,
    save_screen_network,
)

SETTINGS = {"form": "shuffle", "widths": [8, [16, 12], 24], "features": ["ratio", "c_e"]}


def test_a_file_holds_16_bits_and_gives_the_same_network_again(tmp_path):
    path, network = tmp_path / "weights.safetensors", make_screen_network(SETTINGS)
    save_screen_network(path, network, {"network": SETTINGS, "features": ["ratio", "c_e"]})
    loaded, header = load_screen_network(path)
    assert header["network"] == SETTINGS and loaded.features == ("ratio", "c_e")
    for ours, theirs in zip(network.parameters(), loaded.parameters(), strict=True):
        assert theirs.dtype == torch.float32 and torch.equal(ours.half().float(), theirs)
    with safe_open(path, framework="pt") as file:
        assert {file.get_tensor(name).dtype for name in file.keys()} == {torch.float16}


def test_a_file_of_a_network_of_kernels_holds_the_statistics_of_its_norms(tmp_path):
    settings = {"form": "kernels", "widths": [4, 8], "features": ["z", "base_hard"], "filters": 2}
    path, network = tmp_path / "weights.safetensors", make_screen_network(settings)
    for norm in network.norms():
        norm.running_mean += 0.25
    save_screen_network(path, network, {"network": settings})
    loaded, _ = load_screen_network(path)
    assert loaded.features == ("z", "base_hard")
    for name, weight in loaded.state_dict().items():
        assert torch.equal(weight, network.state_dict()[name].half().float()), name


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"widths": [8, 16, 24]}, "size mismatch"),
        ({"widths": [8, 16]}, "Unexpected key"),
        ({"features": ["rat"]}, "'rat'"),
        ({"form": "whole"}, "'whole' found"),
        ({"depth": 3}, "unknown key: 'depth'"),
    ],
)
def test_weights_of_another_width_table_are_refused(tmp_path, change, reason):
    path = tmp_path / "weights.safetensors"
    header = {"network": SETTINGS | change}
    save_screen_network(path, make_screen_network(SETTINGS), header)
    with pytest.raises(InputError, match=f"safetensors: weights do not fit.*{reason}.*train"):
        load_screen_network(path)

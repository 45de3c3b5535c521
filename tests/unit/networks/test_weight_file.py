"""Network files keep every bit, and whatever else is given is refused and not run."""

import json
import pickle
from pathlib import Path

import pytest
import torch

from neural_shadows.errors import InputError
from neural_shadows.networks.object_space.frequency_network import FrequencyNetwork
from neural_shadows.networks.weight_file import (
    load_network,
    load_tensors,
    save_network,
    save_tensors,
)

KIND = {"encoding": "frequency"}
SETTINGS = {"frequencies": 2, "width": 8, "hidden_layers": 2}
HEADER = {"name": "dragon", "network": KIND | SETTINGS, "training": {"learning_rate": 0.1}}


@pytest.fixture
def network() -> FrequencyNetwork:
    network = FrequencyNetwork(**SETTINGS)
    network.initialise(3)
    return network


def assert_refused(path: Path, *words: str) -> None:
    with pytest.raises(InputError) as caught:
        load_network(path)
    message = str(caught.value)
    assert message.startswith(f"{path}: ") and "\n" not in message
    for word in words:
        assert word in message


def test_round_trip(tmp_path, network):
    save_network(tmp_path / "a" / "first.safetensors", network, HEADER)
    loaded, header = load_network(tmp_path / "a" / "first.safetensors")
    assert header == HEADER
    for ours, theirs in zip(network.parameters(), loaded.parameters(), strict=True):
        assert torch.equal(ours, theirs)

    # The order of the header's keys is not the file's: the same network, the same bytes.
    save_network(tmp_path / "again.safetensors", loaded, dict(reversed(HEADER.items())))
    first = (tmp_path / "a" / "first.safetensors").read_bytes()
    assert (tmp_path / "again.safetensors").read_bytes() == first


def test_tensors_keep_every_bit(tmp_path):
    values = torch.tensor([0.1, -0.0, 1e-45, 3.4e38])  # a subnormal and a sign of zero too
    header = {"step": 7, "seconds": 0.1 + 0.2, "curve": [[1, 1e-3, 1 / 3]]}
    table = torch.arange(6.0).reshape(2, 3).T  # not contiguous
    path = tmp_path / "state.safetensors"
    save_tensors(path, {"w": values, "t": table, "s": torch.tensor(2.0)}, header)
    tensors, found = load_tensors(path)
    assert found == header
    assert torch.equal(tensors["w"].view(torch.int32), values.view(torch.int32))
    assert torch.equal(tensors["t"], table)
    assert tensors["s"].shape == ()


def test_a_missing_file_is_named(tmp_path):
    assert_refused(tmp_path / "none.safetensors", "no such file")
    assert_refused(tmp_path, "no such file")


@pytest.mark.parametrize("kept", [0, 4, 100, -1])
def test_a_truncated_file_is_refused(tmp_path, network, kept):
    path = tmp_path / "weights.safetensors"
    save_network(path, network, HEADER)
    path.write_bytes(path.read_bytes()[:kept])
    assert_refused(path, "not a whole file")


def test_a_text_file_is_refused(tmp_path):
    path = tmp_path / "weights.safetensors"
    path.write_text("method,lpips,psnr\nnetwork,0.1,30\n" * 10)
    assert_refused(path, "not a whole file")


class Bomb:
    """Unpickling this makes a file."""

    def __init__(self, path: Path):
        self.path = path

    def __reduce__(self):
        return Path.touch, (self.path,)


@pytest.mark.parametrize("dump", [pickle.dump, torch.save])
def test_a_pickle_is_refused_and_not_run(tmp_path, dump):
    path, exploded = tmp_path / "weights.safetensors", tmp_path / "exploded"
    with path.open("wb") as file:
        dump(Bomb(exploded), file)
    assert_refused(path, "not a whole file")
    assert not exploded.exists()
    pickle.loads(pickle.dumps(Bomb(exploded)))
    assert exploded.exists()  # it would have


def test_a_file_of_others_is_refused(tmp_path):
    from safetensors.torch import save_file

    path = tmp_path / "weights.safetensors"
    save_file({"a": torch.zeros(3)}, path)
    assert_refused(path, "not a whole file")
    save_file({"a": torch.zeros(3)}, path, metadata={"header": "no JSON"})
    assert_refused(path, "not a whole file")


@pytest.mark.parametrize(
    ("network_header", "reason"),
    [
        ({**KIND, **SETTINGS, "width": 16}, "size mismatch"),
        ({**KIND, **SETTINGS, "frequencies": 3}, "size mismatch"),
        ({**KIND, **SETTINGS, "hidden_layers": 3}, "Missing key"),
        ({**KIND, **SETTINGS, "hidden_layers": 1}, "Unexpected key"),
        ({**KIND, "width": 8}, "missing"),
        ({**KIND, **SETTINGS, "bias": True}, "bias"),
        ({**KIND, **SETTINGS, "width": -8}, "negative"),
        ({**KIND, **SETTINGS, "width": "8"}, ""),
        (SETTINGS, "encoding"),
        ({**SETTINGS, "encoding": "wavelet"}, "wavelet"),
        ({**SETTINGS, "encoding": "../../evil"}, "evil"),
        ([8, 2, 2], ""),
        (None, ""),
    ],
)
def test_a_header_that_does_not_fit_is_refused(tmp_path, network, network_header, reason):
    path = tmp_path / "weights.safetensors"
    save_network(path, network, {**HEADER, "network": network_header})
    assert_refused(path, "do not fit the header", reason)


@pytest.mark.parametrize("header", [{"name": "dragon"}, [], None])
def test_a_header_without_network_is_refused(tmp_path, network, header):
    path = tmp_path / "weights.safetensors"
    save_tensors(path, network.state_dict(), header)
    assert_refused(path, "do not fit the header")


def test_the_header_is_json(tmp_path, network):
    """Readable by others: safetensors' own metadata, no format of ours."""
    path = tmp_path / "weights.safetensors"
    save_network(path, network, HEADER)
    content = path.read_bytes()
    size = int.from_bytes(content[:8], "little")
    metadata = json.loads(content[8 : 8 + size])["__metadata__"]
    assert json.loads(metadata["header"]) == HEADER

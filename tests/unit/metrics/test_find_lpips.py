"""LPIPS's trunk: each way to supply it, and one readable line for each way to fail."""

from pathlib import Path
from urllib.error import URLError

import numpy as np
import pytest
import torch
import torchvision

from neural_shadows.errors import InputError
from neural_shadows.files.whole_files import read_json
from neural_shadows.metrics.find_lpips import find_lpips
from neural_shadows.metrics.lpips_trunk import read_trunk


def saved(state: object, path: Path) -> Path:
    torch.save(state, path)
    return path


@pytest.fixture(scope="module")
def features() -> dict[str, torch.Tensor]:
    torch.manual_seed(7)
    return torchvision.models.squeezenet1_1(weights=None).features.state_dict()


def test_whole_classifier_and_features_alone_are_the_same(features, tmp_path):
    whole = {f"features.{key}": value for key, value in features.items()} | {"fc": torch.zeros(2)}
    for name, state in {"whole.pth": whole, "features.pth": features}.items():
        found = read_trunk("squeeze", saved(state, tmp_path / name))
        assert found.keys() == features.keys()
        assert all(torch.equal(found[key], features[key]) for key in features)


class Payload:
    """Makes the folder `path` when it is unpickled."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def __reduce__(self):
        return Path.mkdir, (self.path,)


@pytest.mark.parametrize(
    ("state", "named"),
    [
        (None, "No such file"),
        (b"", "not a whole PyTorch file"),
        (b"<html>403 Forbidden</html>", "not a whole PyTorch file"),
        (torch.zeros(3), "holds one Tensor"),
        ({"3.squeeze.weight": None}, "'3.squeeze.weight' is missing"),
        ({"0.bias": torch.zeros(65)}, "'0.bias' is (65,), that of squeezenet1_1 (64,)"),
        ({"0.bias": torch.full((64,), np.nan)}, "'0.bias' is not of finite"),
        ({"0.bias": Payload}, "not a whole PyTorch file"),
    ],
    ids=["absent", "empty", "page", "tensor", "key", "shape", "nan", "code"],
)
def test_what_is_no_trunk_is_named(state, named, features, tmp_path):
    path, evidence = tmp_path / "trunk.pth", tmp_path / "executed"
    if isinstance(state, bytes):
        path.write_bytes(state)
    elif isinstance(state, dict):
        ((key, value),) = state.items()
        saved(features | {key: Payload(evidence) if value is Payload else value}, path)
    elif state is not None:
        saved(state, path)
    with pytest.raises(InputError) as caught:
        find_lpips(path, tmp_path / "lpips.json", net="squeeze")
    message = str(caught.value)
    assert named in message and "\n" not in message
    assert "trunk.pth" in message and "metrics.lpips.trunk" in message
    assert not evidence.exists() and not (tmp_path / "lpips.json").exists()


def test_a_trunk_that_works_is_written_down(features, tmp_path):
    path = saved(features, tmp_path / "trunk.pth")
    find_lpips(path, tmp_path / "lpips.json", net="squeeze")
    found = read_json(tmp_path / "lpips.json")
    assert found == {"net": "squeeze", "trunk": str(path), "available": True, "reason": None}


@pytest.mark.parametrize(
    ("error", "why"),
    [
        (URLError(OSError("refused")), "refused"),
        (PermissionError(13, "Permission denied", "/home/me/.cache"), "Permission denied"),
        (RuntimeError("invalid hash value"), "invalid hash value"),
    ],
)
def test_without_a_download_lpips_is_left_out(error, why, tmp_path, monkeypatch):
    """The reason is shown in reports, and the cache is in somebody's home."""

    def fail(*_, **__):
        raise error

    monkeypatch.setattr(torch.hub, "download_url_to_file", fail)
    monkeypatch.setenv("TORCH_HOME", str(tmp_path / "home"))
    find_lpips(None, tmp_path / "lpips.json", net="alex")
    found = read_json(tmp_path / "lpips.json")
    assert not found["available"]
    assert f"alexnet cannot be downloaded ({why})" in found["reason"]
    assert "metrics.lpips.trunk" in found["reason"] and "/home" not in found["reason"]

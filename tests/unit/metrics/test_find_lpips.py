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


@pytest.fixture(scope="module")
def features() -> dict[str, torch.Tensor]:
    torch.manual_seed(7)
    return torchvision.models.squeezenet1_1(weights=None).features.state_dict()


@pytest.mark.parametrize("prefix", ["", "features."])
def test_features_alone_or_a_whole_classifier(features, tmp_path, prefix):
    path = tmp_path / "trunk.pth"
    torch.save({prefix + key: value for key, value in features.items()} | {"fc": [2]}, path)
    found = read_trunk("squeeze", path)
    assert found.keys() == features.keys()
    assert all(torch.equal(found[key], features[key]) for key in features)
    find_lpips(path, tmp_path / "lpips.json", net="squeeze")
    expected = {"net": "squeeze", "trunk": str(path), "available": True, "reason": None}
    assert read_json(tmp_path / "lpips.json") == expected


class Payload:
    """Makes the folder `path` when it is unpickled."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def __reduce__(self):
        return Path.mkdir, (self.path,)


@pytest.mark.parametrize(
    ("content", "named"),
    [
        (None, "No such file"),
        (b"<html>403 Forbidden</html>", "no whole PyTorch file of squeezenet1_1's"),
        ({}, "no whole PyTorch file of squeezenet1_1's"),
        ({"0.bias": torch.zeros(65)}, "no whole PyTorch file of squeezenet1_1's"),
        ({"0.bias": torch.full((64,), np.nan)}, "not finite"),
        ({"0.bias": Payload}, "no whole PyTorch file of squeezenet1_1's"),
    ],
    ids=["absent", "page", "missing", "shape", "nan", "code"],
)
def test_what_is_no_trunk_is_named(content, named, features, tmp_path):
    path, evidence = tmp_path / "trunk.pth", tmp_path / "executed"
    if isinstance(content, bytes):
        path.write_bytes(content)
    elif content is not None:
        changed = {key: Payload(evidence) if it is Payload else it for key, it in content.items()}
        torch.save(changed and features | changed, path)
    with pytest.raises(InputError) as caught:
        find_lpips(path, tmp_path / "lpips.json", net="squeeze")
    message = str(caught.value)
    assert named in message and "\n" not in message
    assert "trunk.pth" in message and "metrics.lpips.trunk" in message
    assert not evidence.exists() and not (tmp_path / "lpips.json").exists()


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

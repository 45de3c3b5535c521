from pathlib import Path

import numpy as np
import pytest
import torch
import torchvision
from images import random_image

from neural_shadows.errors import InputError
from neural_shadows.files.whole_files import read_json
from neural_shadows.metrics.find_lpips import find_lpips
from neural_shadows.metrics.registry import image_metrics


def outputs(folder: Path) -> tuple[Path, Path]:
    return folder / "lpips.json", folder / "lpips.onnx"


@pytest.fixture(scope="module")
def features() -> dict[str, torch.Tensor]:
    torch.manual_seed(7)
    return torchvision.models.squeezenet1_1(weights=None).features.state_dict()


def test_features_of_a_whole_classifier(features, tmp_path):
    path = tmp_path / "trunk.pth"
    torch.save({f"features.{key}": value for key, value in features.items()}, path)
    find_lpips(path, *outputs(tmp_path), net="squeeze")
    expected = {"net": "squeeze", "trunk": str(path), "available": True, "reason": None}
    assert read_json(tmp_path / "lpips.json") == expected
    values = image_metrics("hard", tmp_path / "lpips.json")(random_image(0), random_image(1))
    assert values["lpips"] > 1e-3
    (tmp_path / "lpips.onnx").write_bytes(b"cut")
    with pytest.raises(InputError, match="lpips.onnx: damaged .* Delete it and run again"):
        image_metrics("hard", tmp_path / "lpips.json")


@pytest.mark.parametrize(
    ("content", "named"),
    [
        (None, "No such file"),
        (b"<html>403 Forbidden</html>", "not a whole PyTorch file of squeezenet1_1's"),
        ({"0.bias": torch.full((64,), np.nan)}, "not finite"),
    ],
)
def test_what_is_no_trunk_is_named(content, named, features, tmp_path):
    path = tmp_path / "trunk.pth"
    if isinstance(content, bytes):
        path.write_bytes(content)
    elif content:
        torch.save(features | content, path)
    with pytest.raises(InputError, match=f"trunk.pth: .*{named}.*metrics.lpips.trunk"):
        find_lpips(path, *outputs(tmp_path), net="squeeze")


def test_without_a_download_lpips_is_left_out(tmp_path, monkeypatch):
    """The reason is shown in reports, and the cache is in somebody's home."""

    def fail(*_, **__):
        raise PermissionError(13, "Permission denied", "/home/me/.cache")

    monkeypatch.setattr(torch.hub, "download_url_to_file", fail)
    monkeypatch.setenv("TORCH_HOME", str(tmp_path / "home"))
    find_lpips(None, *outputs(tmp_path), net="alex")
    found = read_json(tmp_path / "lpips.json")
    assert (tmp_path / "lpips.onnx").read_bytes() == b""
    assert "lpips" not in image_metrics("hard", tmp_path / "lpips.json")(*[random_image(0)] * 2)
    assert not found["available"] and "/home" not in found["reason"]
    assert "alexnet cannot be downloaded (Permission denied)" in found["reason"]

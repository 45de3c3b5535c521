import os
from pathlib import Path

import lpips
import pytest
import torch
import torchvision
from images import random_image

from neural_shadows.metrics.find_lpips import export_onnx, load_model
from neural_shadows.metrics.kinds.lpips import with_model
from neural_shadows.networks.pretrained_trunk import MODELS


@pytest.mark.parametrize("net", ["squeeze", "alex"])
def test_distance_is_the_packages(net, tmp_path, monkeypatch):
    torch.manual_seed(7)
    model = torchvision.models.get_model(MODELS[net], weights=None)
    torch.save(model.features.state_dict(), tmp_path / "trunk.pth")
    export_onnx(load_model(net, tmp_path / "trunk.pth"), tmp_path / "lpips.onnx")
    distance = with_model(tmp_path / "lpips.onnx", threads=1)
    # lpips cuts up this very classifier by itself.
    monkeypatch.setattr(torchvision.models, MODELS[net], lambda pretrained: model)
    upstream = lpips.LPIPS(net=net, version="0.1", verbose=False)
    for shape in ((64, 80), (75, 131)):
        reference = random_image(0, shape)
        image = reference * random_image(1, shape)
        with torch.inference_mode():
            pair = (torch.tensor(x).expand(1, 3, *x.shape) for x in (image, reference))
            expected = float(upstream(*pair, normalize=True))
        assert expected > 1e-3  # not two zeros
        assert distance(image, reference)["lpips"] == pytest.approx(expected, rel=1e-5, abs=1e-7)
        assert distance(image, image)["lpips"] == 0


def test_published_value():
    """The example in torchmetrics' documentation of LearnedPerceptualImagePatchSimilarity."""
    trunk = os.environ.get("NEURAL_SHADOWS_LPIPS_TRUNK")
    if not trunk:
        pytest.skip("NEURAL_SHADOWS_LPIPS_TRUNK names no file of SqueezeNet 1.1's weights")
    torch.manual_seed(123)
    a, b = (torch.rand(10, 3, 100, 100) * 2 - 1 for _ in range(2))
    with torch.inference_mode():
        mean = load_model("squeeze", Path(trunk))(a, b).mean()
    assert float(mean) == pytest.approx(0.1008, abs=5e-5)

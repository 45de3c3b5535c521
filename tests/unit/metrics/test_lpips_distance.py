"""Metrics against analytic values, against lpips itself, and against published values."""

import os
from pathlib import Path

import lpips
import numpy as np
import pytest
import torch
import torchvision
from images import NO_GREY_IMAGES, constant, random_image

from neural_shadows.metrics.lpips_distance import Lpips
from neural_shadows.metrics.lpips_trunk import TRUNKS
from neural_shadows.metrics.psnr_ssim import psnr, ssim
from neural_shadows.metrics.shadow_error import shadow_error


@pytest.mark.parametrize(("offset", "decibels"), [(0.1, 20.0), (0.01, 40.0), (0.5, 6.0206)])
def test_psnr_of_an_offset(offset, decibels):
    image = 0.5 * random_image(0)
    assert psnr(image + np.float32(offset), image) == pytest.approx(decibels, abs=1e-3)


def test_psnr_of_part_of_the_frame():
    image = constant(0.2)
    image[:16] += 0.1  # a quarter of the pixels: 0.01 / 4
    assert psnr(image, constant(0.2)) == pytest.approx(26.0206, abs=1e-3)


def test_psnr_is_capped():
    image = random_image(0)
    assert psnr(image, image) == 100.0
    assert psnr(constant(0.5 + 1e-6), constant(0.5)) == 100.0  # 120 dB


@pytest.mark.parametrize(("a", "b"), [(0.3, 0.7), (0.0, 1.0), (0.25, 0.26)])
def test_ssim_of_constants(a, b):
    expected = (2 * a * b + 0.01**2) / (a**2 + b**2 + 0.01**2)
    assert ssim(constant(a), constant(b)) == pytest.approx(expected, abs=1e-6)


def test_ssim_is_that_of_wang_2004():
    image, reference = random_image(0), random_image(1)
    assert ssim(image, image) == 1.0

    # The paper's formula with its 11 x 11 window, written out for one pixel.
    offset = np.arange(-5, 6)
    window = np.exp(-(offset**2) / (2 * 1.5**2))
    window = np.outer(window, window) / window.sum() ** 2
    x, y = image[:11, :11].astype(float), reference[:11, :11].astype(float)
    mean_x, mean_y = (window * x).sum(), (window * y).sum()
    variance_x = (window * (x - mean_x) ** 2).sum()
    variance_y = (window * (y - mean_y) ** 2).sum()
    covariance = (window * (x - mean_x) * (y - mean_y)).sum()
    c1, c2 = 0.01**2, 0.03**2
    expected = ((2 * mean_x * mean_y + c1) * (2 * covariance + c2)) / (
        (mean_x**2 + mean_y**2 + c1) * (variance_x + variance_y + c2)
    )
    assert ssim(image[:11, :11], reference[:11, :11]) == pytest.approx(expected, abs=1e-5)


def test_shadow_error_by_hand():
    #                    fine  fine   dark   dark   leak   unseen unseen background
    lit = np.array([[True, False, False, False, True, True, False, True]])
    reference = np.array([[True, False, True, True, False, False, True, True]])
    mask = np.array([[True, True, True, True, True, False, False, False]])
    error = shadow_error(lit, reference, mask)
    assert error.false_shadow == pytest.approx(2 / 5)
    assert error.light_leak == pytest.approx(1 / 5)
    assert error.total == pytest.approx(3 / 5)


def test_shadow_error_refuses_an_empty_mask():
    frame = np.zeros((4, 4), bool)
    with pytest.raises(ValueError, match="no pixel"):
        shadow_error(frame, frame, frame)


@pytest.mark.parametrize("metric", [psnr, ssim])
@pytest.mark.parametrize("image", NO_GREY_IMAGES)
def test_what_is_no_grey_image_is_refused(metric, image):
    with pytest.raises(ValueError, match="grey|\\[0, 1\\]"):
        metric(image, constant(0.5))


@pytest.fixture
def random_trunk(tmp_path, monkeypatch):
    """Make a file of random weights for `net`, and lpips's own metric with these weights."""

    def make(net: str) -> tuple[Path, lpips.LPIPS]:
        torch.manual_seed(7)
        name = TRUNKS[net].model
        classifier = torchvision.models.get_model(name, weights=None)
        path = tmp_path / f"{net}.pth"
        torch.save(classifier.features.state_dict(), path)
        # lpips cuts up this very classifier by itself.
        monkeypatch.setattr(torchvision.models, name, lambda pretrained: classifier)
        upstream = lpips.LPIPS(net=net, version="0.1", verbose=False)
        monkeypatch.undo()
        return path, upstream

    return make


def upstream_distance(upstream: lpips.LPIPS, image: np.ndarray, reference: np.ndarray) -> float:
    a, b = (torch.tensor(x).expand(1, 3, *x.shape) for x in (image, reference))
    with torch.inference_mode():
        return float(upstream(2 * a - 1, 2 * b - 1))


@pytest.mark.parametrize("net", ["squeeze", "alex", "vgg"])
def test_lpips_equals_the_package(net, random_trunk):
    path, upstream = random_trunk(net)
    metric = Lpips(net, path)
    reference = random_image(0)
    features = metric.features(reference)
    for seed in (1, 2):  # the reference's features serve more than one method
        image = reference * random_image(seed)
        expected = upstream_distance(upstream, image, reference)
        assert expected > 1e-3  # not two zeros
        assert metric.distance(image, features) == pytest.approx(expected, rel=1e-5, abs=1e-7)
    assert metric.distance(reference, features) == 0.0


def test_lpips_refuses_what_is_no_grey_image(random_trunk):
    metric = Lpips("squeeze", random_trunk("squeeze")[0])
    with pytest.raises(ValueError, match="\\[0, 1\\]"):
        metric.features(constant(255.0))


def test_lpips_published_value():
    """The example in torchmetrics' documentation of LearnedPerceptualImagePatchSimilarity."""
    trunk = os.environ.get("NEURAL_SHADOWS_SQUEEZE_TRUNK")
    if not trunk:
        pytest.skip("NEURAL_SHADOWS_SQUEEZE_TRUNK names no file of SqueezeNet 1.1's weights")
    metric = Lpips("squeeze", Path(trunk))
    torch.manual_seed(123)
    a, b = (torch.rand(10, 3, 100, 100) * 2 - 1 for _ in range(2))
    with torch.inference_mode():  # the example is in colour, `distance` is for grey
        assert float(metric._model(a, b).mean()) == pytest.approx(0.1008, abs=5e-5)
    image, reference = random_image(0), random_image(1)
    assert metric.distance(image, metric.features(reference)) == pytest.approx(
        upstream_distance(metric._model, image, reference), abs=1e-6
    )

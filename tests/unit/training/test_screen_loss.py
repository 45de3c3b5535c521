"""Gradients of the terms of the screen-space loss."""

import pytest
import torch
import torchvision

from neural_shadows.errors import InputError
from neural_shadows.training.perceptual import MeanSquare, Perceptual
from neural_shadows.training.screen_loss import ScreenLoss

SHAPE = (1, 1, 32, 32)
EVERY = torch.ones(SHAPE, dtype=torch.bool)


@pytest.fixture(scope="module")
def trunk(tmp_path_factory):
    path = tmp_path_factory.mktemp("trunk") / "squeeze.pth"
    torch.manual_seed(3)
    torch.save(torchvision.models.squeezenet1_1(weights=None).features.state_dict(), path)
    return path


def pictures():
    generator = torch.Generator().manual_seed(1)
    return [torch.rand(SHAPE, generator=generator, requires_grad=True) for _ in range(3)]


def perceptual(trunk):
    return Perceptual("squeeze", trunk, torch.device("cpu"), torch.float32)


@pytest.mark.parametrize("alpha", [1.0, 0.0], ids=["L1", "perceptual"])
@pytest.mark.parametrize("against", ["target", "twin"])
def test_each_term_moves_the_output_and_nothing_else(trunk, alpha, against):
    output, target, twin = pictures()
    loss = ScreenLoss(alpha, 3.0, perceptual(trunk))
    loss.factor = 1.0
    if against == "twin":
        target = output.detach().clone()  # no loss, no gradient from there
    total = loss(
        output, target.detach(), EVERY, EVERY.sum(), *((twin, EVERY) * (against == "twin"))
    )
    total.backward()
    assert output.grad.abs().max() > 1e-7
    assert twin.grad is None


def test_the_mean_square_and_its_gradient():
    a, b = (torch.randn(2, 3, 5, 7, requires_grad=True) for _ in range(2))
    result = MeanSquare.apply(a, b)
    expected = torch.nn.functional.mse_loss(a, b)
    assert result.item() == pytest.approx(expected.item(), rel=1e-5)
    gradients = [torch.autograd.grad(3 * value, a)[0] for value in (result, expected)]
    assert torch.allclose(*gradients, rtol=1e-5)
    reduced = MeanSquare.apply(a.bfloat16(), b.bfloat16())
    assert reduced.item() == pytest.approx(expected.item(), rel=0.02)


def test_an_identical_perturbed_frame_adds_no_loss(trunk):
    output, target, _ = pictures()
    loss = ScreenLoss(0.9, 3.0, perceptual(trunk))
    loss.factor = 1.0
    alone, both = (
        loss(output, target, EVERY, 1024, *arguments)
        for arguments in ((), (output.detach(), EVERY))
    )
    assert both.item() == alone.item() > 0


def test_invalid_pixels_have_no_gradient(trunk):
    output, target, _ = pictures()
    valid = EVERY.clone()
    valid[..., :16] = False
    loss = ScreenLoss(0.9, 0.0, perceptual(trunk))
    loss.factor = 1.0
    loss(output, target, valid, 512).backward()
    assert output.grad[..., :16].abs().max() == 0 < output.grad[..., 16:].abs().min()
    alone = ScreenLoss(1.0, 0.0, None)(output, target, valid, 512)
    assert alone.item() == pytest.approx((output - target)[..., 16:].abs().mean().item())


def test_at_its_factor_the_perceptual_term_is_half_of_l1(trunk):
    output, target, _ = pictures()
    loss = ScreenLoss(0.9, 0.0, perceptual(trunk))
    (terms,) = loss.terms(output.detach(), EVERY, [(target.detach(), EVERY)], 1024)
    loss.factor = loss.factor_for(terms)
    assert loss(output, target, EVERY, 1024).item() == pytest.approx(1.5 * 0.9 * terms.l1.item())


@pytest.mark.parametrize(
    ("net", "key"), [("squeeze", "metrics.lpips.trunk"), ("vgg19", "perceptual.trunk")]
)
def test_unusable_backbones_are_refused(tmp_path, net, key):
    for content in (None, b"not found"):
        path = tmp_path / f"{net}.pth"
        if content:
            path.write_bytes(content)
        with pytest.raises(InputError, match=f"{key}: {net}.pth: unusable .*Set {key} "):
            Perceptual(net, path, torch.device("cpu"), torch.float32)

"""The dead-zone loss is zero between its bounds and the distance to them outside."""

import math

import pytest
import torch

from neural_shadows.networks.object_space.dead_zone_loss import DeadZone

# t, t_lb, t_ub, loss, gradient
CASES = [
    (0.25, 0.5, 1.0, 0.25, -1.0),
    (0.75, 0.5, 1.0, 0.0, 0.0),
    (1.5, 0.5, 1.0, 0.5, 1.0),
    (0.5, 0.5, 1.0, 0.0, 0.0),  # on the bounds
    (1.0, 0.5, 1.0, 0.0, 0.0),
    (0.0, 2.0, math.inf, 2.0, -1.0),
    (2.5, 2.0, math.inf, 0.0, 0.0),  # one hit, or none: too far is never wrong
    (0.25, 0.5, 0.5, 0.25, -1.0),  # an interval of no length
]


@pytest.mark.parametrize(("t", "t_lb", "t_ub", "loss", "gradient"), CASES)
def test_value_and_gradient(t, t_lb, t_ub, loss, gradient):
    prediction = torch.tensor([t], requires_grad=True)
    found = DeadZone()(prediction, torch.tensor([t_lb]), torch.tensor([t_ub]))
    found.sum().backward()
    assert found.tolist() == [loss]
    assert prediction.grad.tolist() == [gradient]  # NaN equals nothing


def test_each_sample_by_itself():
    t, t_lb, t_ub, loss, _ = torch.tensor(CASES).T
    assert torch.equal(DeadZone()(t, t_lb, t_ub), loss)


@pytest.mark.parametrize("t", [math.nan, math.inf])
def test_what_is_no_depth_shows_in_the_loss(t):
    bounds = torch.tensor([0.5]), torch.tensor([math.inf])
    assert not torch.isfinite(DeadZone()(torch.tensor([t]), *bounds)).any()


def test_weights_of_false_shadow_and_light_leak():
    t = torch.tensor([0.1, 0.3, 0.9])
    loss = DeadZone(false_shadow=3, light_leak=2)(t, torch.full((3,), 0.2), torch.full((3,), 0.5))
    assert loss == pytest.approx([0.3, 0, 0.8])


def test_pull_to_the_middle_between_finite_bounds_only():
    t = torch.tensor([0.1, 0.3, 0.4, 0.9, 0.3], requires_grad=True)
    t_ub = torch.tensor([0.6, 0.6, 0.6, 0.6, math.inf])
    loss = DeadZone(middle_pull=0.5)(t, torch.full((5,), 0.2), t_ub)
    assert loss.tolist() == pytest.approx([0.1, 0.05, 0, 0.3, 0], abs=1e-6)
    (gradient,) = torch.autograd.grad(loss.sum(), t)
    assert gradient.isfinite().all()
    assert gradient[[0, 1, 3, 4]].tolist() == pytest.approx([-1, -0.5, 1, 0], abs=1e-6)

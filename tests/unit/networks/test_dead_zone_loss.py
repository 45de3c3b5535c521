"""Dead-zone loss and gradient inside and outside its bounds."""

import math

import pytest
import torch

from neural_shadows.networks.object_space.dead_zone_loss import DeadZone


@pytest.mark.parametrize(
    ("t", "t_lb", "t_ub", "loss", "gradient"),
    [
        (0.25, 0.5, 1.0, 0.25, -1.0),
        (0.75, 0.5, 1.0, 0.0, 0.0),
        (1.5, 0.5, 1.0, 0.5, 1.0),
        (0.5, 0.5, 1.0, 0.0, 0.0),  # on a bound
        (2.5, 2.0, math.inf, 0.0, 0.0),  # one hit, or none: too far is never wrong
    ],
)
@pytest.mark.parametrize("weight", [1, 3])
def test_value_and_gradient(t, t_lb, t_ub, loss, gradient, weight):
    prediction = torch.tensor([t], requires_grad=True)
    losses = DeadZone(false_shadow=weight)(prediction, torch.tensor([t_lb]), torch.tensor([t_ub]))
    losses.sum().backward()
    factor = weight if t < t_lb else 1
    assert losses.tolist() == [factor * loss]
    assert prediction.grad.tolist() == [factor * gradient]  # NaN equals nothing

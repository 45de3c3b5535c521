"""Loss of predicting no shadow, against its closed form."""

import numpy as np
import pytest
from rays import ball_rays, open_rays, write_ball_rays

from neural_shadows.networks.object_space.dead_zone_loss import DeadZone
from neural_shadows.training import no_shadow
from neural_shadows.training.no_shadow import no_shadow_loss


def test_loss_of_a_ball(tmp_path, monkeypatch):
    """Five eighths of the rays hit, evenly over the disk of radius 1/2.

    Beyond the ball there is left √(1 − r²) − √(1/4 − r²), whose mean over the disk is
    (8/3) (1 − (3/4)^(3/2)) − 1/3.
    """
    write_ball_rays(tmp_path, 20_000)
    expected = 5 / 8 * (8 / 3 * (1 - 0.75**1.5) - 1 / 3)
    rays = open_rays(tmp_path)
    assert no_shadow_loss(rays, DeadZone()) == pytest.approx(expected, abs=0.005)
    # In chunks, and of every third ray alone.
    monkeypatch.setattr(no_shadow, "_CHUNK", 999)
    whole = no_shadow_loss(rays, DeadZone(false_shadow=3.0))  # it never errs to that side
    o, d, _, t_ub = (part.astype(float) for part in ball_rays(20_000))
    loss = np.maximum(-2 * np.sum(o * d, axis=1) - t_ub, 0)
    assert whole == pytest.approx(loss.mean(), rel=1e-5)
    monkeypatch.setattr(no_shadow, "RAYS", 6_667)
    some = np.arange(6_667) * 20_000 // 6_667
    assert no_shadow_loss(rays, DeadZone()) == pytest.approx(loss[some].mean(), rel=1e-5)

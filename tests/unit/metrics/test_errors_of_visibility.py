"""Errors of soft visibility, with the papers' vectors."""

import numpy as np
import pytest

from neural_shadows.metrics.kinds.errors_of_visibility import of_visibility
from neural_shadows.metrics.kinds.instability import exponential_instability, root_instability
from neural_shadows.metrics.metric import Pixels


def test_parts_of_the_error():
    target = np.zeros((20, 40), np.float32)
    target[:, 20:] = 1
    target[:, 18:22] = [0.2, 0.4, 0.6, 0.8]
    hard = (np.arange(40) >= 20).astype(np.float32) * np.ones((20, 1), np.float32)
    found = target.copy()
    found[:, :18] += 0.1
    found[:, 18:22] -= 0.2
    found[:, 22:] -= 0.3
    valid = np.ones((20, 40), bool)
    errors = of_visibility(found, target, Pixels(valid, hard))
    assert errors["mse_umbra"] == pytest.approx(0.01, rel=1e-5)
    assert errors["mse_penumbra"] == pytest.approx(0.04, rel=1e-5)
    assert errors["mse_lit"] == pytest.approx(0.09, rel=1e-5)
    assert errors["mse"] == pytest.approx((18 * 0.01 + 4 * 0.04 + 18 * 0.09) / 40, rel=1e-5)
    assert errors["light_leak"] == pytest.approx(18 * 0.1 / 40, rel=1e-5)
    assert errors["false_shadow"] == pytest.approx((4 * 0.2 + 18 * 0.3) / 40, rel=1e-5)
    assert errors["l1"] == pytest.approx(errors["light_leak"] + errors["false_shadow"])
    # Three pixels on each side of the edge between 19 and 20.
    assert errors["mse_edge"] == pytest.approx((0.01 + 4 * 0.04 + 0.09) / 6, rel=1e-5)
    valid[:, 18:] = False
    assert np.isnan(of_visibility(found, target, Pixels(valid, hard))["mse_lit"])
    with pytest.raises(ValueError, match="no pixel"):
        of_visibility(found, target, Pixels(np.zeros_like(valid), hard))


def test_published_vectors_of_instability():
    assert exponential_instability([np.full(7, 0.1)]) == pytest.approx(0.349859, abs=1e-6)
    assert exponential_instability([np.full(3, -1.0), np.zeros(0)]) == pytest.approx(
        19.0855, abs=1e-4
    )
    assert exponential_instability([np.zeros(5)]) == 0
    assert root_instability([np.full(50, 0.2), np.zeros(100)], 100) == pytest.approx(0.1)
    with pytest.raises(ValueError, match="no pixel"):
        exponential_instability([np.zeros(0)])

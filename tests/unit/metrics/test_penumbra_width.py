"""The mean width of penumbrae, of discs whose edges have every direction."""

import numpy as np
import pytest

from neural_shadows.metrics.penumbra_width import penumbra_width

SIDE, RADIUS = 400, 120.0
PLACES = np.hypot(*(np.indices((SIDE, SIDE)) + 0.5 - SIDE / 2))
HARD = (PLACES > RADIUS).astype(np.float32)
VALID = np.ones((SIDE, SIDE), bool)


@pytest.mark.parametrize("width", [10.0, 40.0])
def test_a_round_shadow_s_penumbra_is_as_wide_as_it_was_made(width):
    soft = np.clip(0.5 + (PLACES - RADIUS) / width, 0, 1)
    assert penumbra_width(soft, VALID, HARD) == pytest.approx(width, rel=0.03)


def test_only_what_counts_is_measured():
    soft = np.clip(0.5 + (PLACES - RADIUS) / 20, 0, 1)
    half = VALID & (np.arange(SIDE) < SIDE // 2)
    soft[~half] = 0.5
    assert penumbra_width(soft, half, HARD) == pytest.approx(20, rel=0.03)
    assert penumbra_width(HARD, VALID, HARD) == 0
    assert np.isnan(penumbra_width(soft, VALID, np.ones_like(HARD)))

"""Widths of a point light's edges, of pictures that are sharp or not, there or not."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter

from neural_shadows.metrics.kinds.edge_width import edge_width, of_visibility
from neural_shadows.metrics.metric import Pixels

SIDE, RADIUS = 300, 90.0
PLACES = np.hypot(*(np.indices((SIDE, SIDE)) + 0.5 - SIDE / 2))
HARD = (PLACES > RADIUS).astype(np.float32)
PIXELS = Pixels(np.ones((SIDE, SIDE), bool), HARD)


def test_a_blurred_edge_is_as_wide_as_its_blur():
    """Of a Gaussian from 10 to 90 %, over 0.8: 3.2 standard deviations."""
    assert edge_width(HARD, PIXELS) == 0
    assert edge_width(gaussian_filter(HARD, 1.0), PIXELS) == pytest.approx(3.2, rel=0.1)
    assert edge_width(gaussian_filter(HARD, 6.0), PIXELS) == pytest.approx(
        8.4, rel=0.02
    )  # the band


def test_what_is_missing_or_elsewhere_is_not_sharp():
    """Half of the edge is not there, the other half is blurred; and all is grey a little away from it."""
    soft = gaussian_filter(HARD, 1.0)
    half = np.where(np.arange(SIDE) < SIDE // 2, soft, np.float32(1))
    assert edge_width(half, PIXELS) == pytest.approx(edge_width(soft, PIXELS), rel=0.05)
    grey = np.where(np.abs(PLACES - RADIUS) > 8, np.float32(0.85), soft)
    assert edge_width(grey, PIXELS) == edge_width(soft, PIXELS)
    assert np.isnan(edge_width(np.ones_like(HARD), PIXELS))
    assert np.isnan(edge_width(np.roll(HARD, (SIDE // 2, SIDE // 2), (0, 1)), PIXELS))


def test_other_lights_have_no_edges():
    found = of_visibility(HARD, gaussian_filter(HARD, 3.0), PIXELS)
    found |= of_visibility(HARD, HARD, replace(PIXELS, hard=None))
    assert np.isnan([*found.values()]).all() and len(found) == 2
    assert of_visibility(HARD, HARD, PIXELS) == dict.fromkeys(found, 0.0)

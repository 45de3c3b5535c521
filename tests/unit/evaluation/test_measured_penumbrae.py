"""How wide penumbrae are measured to be."""

import numpy as np
import pytest

from neural_shadows.evaluation.measured_penumbrae import measured_widths

ROWS, COLUMNS = np.mgrid[0:80, 0:120].astype(float)
PLACE = np.array([[40], [60]])


def ramp(width, turn=0.0):
    across = (COLUMNS - 60) * np.cos(turn) + (ROWS - 40) * np.sin(turn)
    return np.clip(0.5 + across / width, 0, 1).astype(np.float32)


@pytest.mark.parametrize(("width", "turn"), [(20, 0.0), (20, np.pi), (33, 0.7), (8, 2.1)])
def test_a_ramp_is_as_wide_as_it_is(width, turn):
    found = measured_widths(ramp(width, turn), np.ones((80, 120), bool), PLACE)
    assert found[0] == pytest.approx(width, abs=2.5)  # of whole steps to both ends


def test_what_has_no_end_on_its_surface_has_no_width():
    near = np.ones((80, 120), bool)
    plateau = np.maximum(ramp(20), 0.3)  # another light falls into the umbra
    assert np.isnan(measured_widths(plateau, near, PLACE))[0]
    near[:, 64] = False  # another surface
    assert np.isnan(measured_widths(ramp(20), near, PLACE))[0]
    assert np.isnan(measured_widths(ramp(400), near, PLACE))[0]  # leaves the frame

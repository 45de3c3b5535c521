"""Errors by what blocks the light, of errors that are made."""

import numpy as np
import pytest

from neural_shadows.metrics.kinds.errors_by_occluders import of_occluders

SOLIDS = np.tile(np.repeat([0, 1, 2, 3, 5], 20), (4, 1)).astype(np.float16)  # as they are stored
TARGET = np.full(SOLIDS.shape, 0.5, np.float32)
VALID = np.ones(SOLIDS.shape, bool)
WIDTHS = np.tile(np.arange(100.0), (4, 1))


def errors(off, target=TARGET, valid=VALID, solids=SOLIDS):
    return of_occluders(target + off.astype(np.float32), target, valid, solids, WIDTHS)


def test_each_number_of_solids_has_its_error():
    """A squared error of 0.01 for each, five of which are three."""
    found = errors(np.sqrt(0.01 * np.minimum(np.float64(SOLIDS), 3)))
    means = [found[f"mse_solids_{number}"] for number in (1, 2, 3)]
    assert means == pytest.approx([0.01, 0.02, 0.03], rel=1e-4)
    assert found["mse_per_solid"] == pytest.approx(0.01, rel=1e-4)
    assert found["solids_behind"] == 2.25 and found["mse_behind"] == pytest.approx(0.0225, rel=1e-4)
    assert errors(0.1 + 0 * SOLIDS)["mse_per_solid"] == pytest.approx(0, abs=1e-8)


def test_the_widest_tenth_of_the_penumbra():
    """Of those 80 columns that lie in a penumbra the last 8."""
    target = np.where(WIDTHS < 80, TARGET, 1)
    off = np.where((WIDTHS >= 72) & (WIDTHS < 80), 0.2, 0.1)
    assert errors(off, target=target)["mse_widest"] == pytest.approx(0.04, rel=0.1)
    assert errors(off, target=target, valid=WIDTHS < 72)["mse_widest"] == pytest.approx(0.01)


def test_what_no_pixel_has_is_no_number():
    found = errors(0.1 + 0 * SOLIDS, target=np.ones_like(TARGET), solids=np.minimum(SOLIDS, 1))
    assert np.isnan([found[name] for name in ("mse_widest", "mse_solids_2", "mse_per_solid")]).all()
    assert np.isnan(errors(0 * SOLIDS, solids=0 * SOLIDS)["mse_behind"])

"""Denoised rays beside the exact soft shadow."""

from dataclasses import replace

import numpy as np
import pytest
from plate_frames import RADIUS, error, plate_frame, plate_truth

from neural_shadows.evaluation.soft_methods.denoised import (
    oidn_denoised,
    svgf_denoised,
    svgf_sequence,
)
from neural_shadows.evaluation.soft_methods.ray_traced import ray_traced


@pytest.fixture(scope="module")
def frame():
    return plate_frame()


@pytest.mark.parametrize("denoised, factor", [(svgf_denoised, 6), (oidn_denoised, 15)])
def test_two_rays_denoised(frame, denoised, factor):
    if denoised is oidn_denoised:
        pytest.importorskip("pyoidn", reason="no pyoidn for this machine")
    raw = ray_traced(frame, RADIUS, samples=2)
    found = denoised(frame, RADIUS, samples=2)
    assert found.dtype == np.float32 and found.min() >= 0 and found.max() <= 1
    assert factor * error(found, plate_truth()) < error(raw, plate_truth())
    # A point's shadow has no noise.
    assert np.array_equal(denoised(frame, 0, samples=2), ray_traced(frame, 0, samples=1))


def test_a_sequence_gets_better(frame):
    errors = [
        error(found, plate_truth())
        for found in svgf_sequence((replace(frame, number=k) for k in range(12)), RADIUS, samples=1)
    ]
    assert errors[0] == pytest.approx(
        error(svgf_denoised(frame, RADIUS, samples=1), plate_truth()), rel=1e-3
    )
    assert errors[3] < errors[0] / 4 and errors[11] < errors[0] / 6

"""Frames of a sequence, added up."""

import numpy as np
import pytest
from plate_frames import HEIGHT, WIDTH, error, plate_frame, plate_truth

from neural_shadows.denoising.temporal import TemporalFilter


def noisy(truth, rng):
    """One ray a pixel."""
    return (rng.random(len(truth)) < truth).astype(np.float32).reshape(HEIGHT, WIDTH)


def errors_of(shifts, seed=0):
    """Mean squared errors of a sequence's frames, whose camera moves by `shifts`."""
    rng, svgf, errors = np.random.default_rng(seed), TemporalFilter(HEIGHT, WIDTH), []
    for shift in shifts:
        truth = plate_truth(shift)
        found = svgf.next_frame(noisy(truth, rng), plate_frame(shift).surface)
        assert found.min() >= 0 and found.max() <= 1
        errors.append(error(found, truth))
    return errors


def test_errors_fall_while_nothing_moves():
    errors = np.mean([errors_of([0.0] * 12, seed) for seed in range(3)], axis=0)
    assert errors[1] < errors[0] and errors[3] < errors[0] / 2 and errors[11] < errors[0] / 3


def test_what_was_seen_is_found_under_a_moving_camera():
    moving = errors_of([0.02 * step for step in range(4)])
    assert moving[3] < moving[0] / 1.5


def test_what_was_not_seen_begins_anew():
    rng, truth = np.random.default_rng(1), plate_truth()
    svgf, fresh = (TemporalFilter(HEIGHT, WIDTH) for _ in range(2))
    picture, surface = noisy(truth, rng), plate_frame().surface
    svgf.next_frame(np.zeros((HEIGHT, WIDTH), np.float32), surface)
    found = svgf.next_frame(picture, surface, was=surface.p + np.float32(9))
    alone = fresh.next_frame(picture, surface)
    assert np.array_equal(found, alone)


def test_an_even_mean_first_and_a_fifth_later():
    """A constant picture that becomes another: the share of the new is 1/2, 1/3, 1/4, 1/5, 1/5 …"""
    svgf, surface = TemporalFilter(HEIGHT, WIDTH), plate_frame().surface
    seen = [
        svgf.next_frame(np.full((HEIGHT, WIDTH), value, np.float32), surface)[
            HEIGHT // 2, WIDTH // 2
        ]
        for value in (1, 0, 0, 0, 0, 0)
    ]
    assert seen == pytest.approx([1, 1 / 2, 1 / 3, 1 / 4, 1 / 5, 4 / 25], abs=1e-3)

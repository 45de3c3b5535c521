"""Temporal anti-aliasing."""

import numpy as np
import pytest

from neural_shadows.denoising.taa import DEVIATIONS, SHARE, blended, recursive


def test_one_frame_is_averaged_where_it_was_seen():
    image = np.array([[0.2, 0.4]], np.float32)
    new = blended(image, np.array([1]), np.array([1.0]))
    assert new == pytest.approx(np.array([[0.2, 0.7]]), abs=1e-6)
    assert (image == np.float32([[0.2, 0.4]])).all()


def test_a_history_within_its_neighbourhood_is_kept_but_for_a_share():
    rng = np.random.default_rng(1)
    image = rng.random((9, 9), np.float32)
    pixel = np.array([40])  # in the middle
    near = image[3:6, 3:6].astype(float)
    past = np.float32(near.mean() + 0.5 * near.std())
    (new,) = recursive(image, pixel, np.array([past])).ravel()[pixel]
    assert new == pytest.approx(past + SHARE * (image[4, 4] - past), abs=1e-5)
    (new,) = recursive(image, pixel, np.array([9.0], np.float32)).ravel()[pixel]
    end = near.mean() + DEVIATIONS * near.std()
    assert new == pytest.approx(end + SHARE * (image[4, 4] - end), abs=1e-5)


def test_what_is_even_has_no_history():
    """A shadow that left is gone at once, away from its edge."""
    image = np.full((5, 5), 0.25, np.float32)
    new = recursive(image, np.arange(25), np.zeros(25, np.float32))
    assert new == pytest.approx(image, abs=1e-4)


def test_noise_at_rest_is_accumulated():
    """Of independent frames a share leaves share / (2 − share) of the variance; clipping blurs a little, too."""
    rng = np.random.default_rng(2)
    frames = rng.normal(0.5, 0.1, (60, 64, 64)).astype(np.float32)
    shown, pixel = frames[0], np.arange(64 * 64)
    for frame in frames[1:]:
        shown = recursive(frame, pixel, shown.ravel())
    assert shown.var() == pytest.approx(0.1**2 * SHARE / (2 - SHARE), rel=0.2)
    assert shown.mean() == pytest.approx(0.5, abs=2e-3)

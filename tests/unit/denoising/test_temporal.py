"""Frames of a sequence, added up by each filter that has a history."""

import numpy as np
import pytest
from plate_frames import HEIGHT, RADIUS, WIDTH, error, plate_frame, plate_truth

from neural_shadows.denoising.ffx import FfxTrials, TemporalFfx
from neural_shadows.denoising.sigma import SigmaFilter, TemporalSigma
from neural_shadows.denoising.sigma_ffx import SigmaFfxTrials, TemporalSigmaFfx
from neural_shadows.denoising.svgf import SvgfTrials
from neural_shadows.denoising.temporal import TemporalFilter
from neural_shadows.rendering.reprojection import Reprojection

KINDS = {
    "svgf": TemporalFilter,
    "ffx": TemporalFfx,
    "sigma": TemporalSigma,
    "sigma_ffx": TemporalSigmaFfx,
}
ALONE = {
    "svgf": SvgfTrials,
    "ffx": FfxTrials,
    "sigma": SigmaFilter,
    "sigma_ffx": SigmaFfxTrials,
}


def noisy(truth, rng):
    """One ray a pixel."""
    return (rng.random(len(truth)) < truth).astype(np.float32).reshape(HEIGHT, WIDTH)


def pictures(key, visibility):
    """With how wide the ball's penumbra is."""
    if not key.startswith("sigma"):
        return (visibility,)
    return visibility, np.where(visibility < 1, np.float32(0.4 * RADIUS), np.float32(-1))


def alone(key, visibility, surface):
    """By the form for one frame."""
    return ALONE[key](HEIGHT, WIDTH).single(*pictures(key, visibility), surface)


def sequence(key, shifts, seed=0):
    """Pictures of a sequence's frames, whose camera moves by `shifts`."""
    rng, filter_, before = np.random.default_rng(seed), KINDS[key](HEIGHT, WIDTH), None
    for shift in shifts:
        visibility, surface = noisy(plate_truth(shift), rng), plate_frame(shift).surface
        back = before and Reprojection(surface, before)
        found, before = filter_.next_frame(*pictures(key, visibility), surface, back), surface
        assert found.dtype == np.float32 and found.min() >= 0 and found.max() <= 1
        yield found


def errors_of(key, shifts, seed=0):
    found = sequence(key, shifts, seed)
    return [error(one, plate_truth(shift)) for one, shift in zip(found, shifts)]


@pytest.mark.parametrize("key", KINDS)
def test_what_was_seen_is_found_under_a_moving_camera(key):
    moving = errors_of(key, [0.02 * step for step in range(12)])
    assert np.mean(moving[8:]) < 0.85 * moving[0]


@pytest.mark.parametrize("key", KINDS)
def test_what_was_not_seen_begins_anew(key):
    rng, truth = np.random.default_rng(1), plate_truth()
    picture, surface = noisy(truth, rng), plate_frame().surface
    filter_ = KINDS[key](HEIGHT, WIDTH)
    dark = np.zeros((HEIGHT, WIDTH), np.float32)
    filter_.next_frame(*pictures(key, dark), surface)
    elsewhere = Reprojection(surface, surface, surface.p + np.float32(9))
    found = filter_.next_frame(*pictures(key, picture), surface, elsewhere)
    # SIGMA's sparse taps turn from frame to frame.
    close = 0.15 if key.startswith("sigma") else 1e-6
    assert np.abs(found - alone(key, picture, surface)).max() < close


@pytest.mark.parametrize("key", KINDS)
def test_a_sequence_is_the_same_again(key):
    first, again = (np.array([*sequence(key, [0.0, 0.02, 0.04])]) for _ in range(2))
    assert np.array_equal(first, again)


def test_an_even_mean_first_and_a_fifth_later():
    """A constant picture that becomes another: the share of the new is 1/2, 1/3, 1/4, 1/5, 1/5 …"""
    svgf, surface = TemporalFilter(HEIGHT, WIDTH), plate_frame().surface
    back, pictures_ = Reprojection(surface, surface), np.ones((6, HEIGHT, WIDTH), np.float32)
    pictures_[1:] = 0
    seen = [svgf.next_frame(one, surface, back)[HEIGHT // 2, WIDTH // 2] for one in pictures_]
    assert seen == pytest.approx([1, 1 / 2, 1 / 3, 1 / 4, 1 / 5, 4 / 25], abs=1e-3)


@pytest.mark.parametrize("key", ["svgf", "ffx"])
def test_without_passes_a_picture_is_no_view_of_the_history(key):
    surface, rng = plate_frame().surface, np.random.default_rng(4)
    back, first = Reprojection(surface, surface), noisy(plate_truth(), rng)
    found = []
    for spoilt in (False, True):
        filter_ = KINDS[key](HEIGHT, WIDTH, passes=0)
        shown = filter_.next_frame(first.copy(), surface)
        shown[:] = shown if not spoilt else 9
        found.append(filter_.next_frame(first.copy(), surface, back))
    assert np.array_equal(*found)


def test_a_picture_without_history_is_still_smoothed_by_its_noise():
    """Whose moments have a history: a share of 1 is of the picture alone."""
    surface, rng = plate_frame().surface, np.random.default_rng(5)
    back, truth = Reprojection(surface, surface), plate_truth()
    svgf = TemporalFilter(HEIGHT, WIDTH, share=1.0)
    for _ in range(8):
        picture = noisy(truth, rng)
        found = svgf.next_frame(picture, surface, back)
    assert error(found, truth) < 0.3 * error(picture, truth)


@pytest.mark.parametrize("key", ["ffx", "sigma_ffx"])
def test_a_share_of_one_is_no_history(key):
    """So a search that tries it does no worse, on its own frames, than without a history."""
    rng, filter_, before = np.random.default_rng(0), KINDS[key](HEIGHT, WIDTH, share=1.0), None
    for shift in (0.0, 0.02, 0.04, 0.06, 0.08):
        visibility, surface = noisy(plate_truth(shift), rng), plate_frame(shift).surface
        back = before and Reprojection(surface, before)
        found, before = filter_.next_frame(*pictures(key, visibility), surface, back), surface
        assert np.abs(found - alone(key, visibility, surface)).max() < 1e-6

import numpy as np
import pytest

from neural_shadows.metrics import power_law
from neural_shadows.metrics.power_law import Curve

SAMPLES = 1024.0 * np.array([500, 1250, 3150, 8000, 20_000])
BEYOND = 20 * SAMPLES[-1]
# Mean loss of the last tenth on the dragon at 0.64 to 20.48 M samples, one seed: encoded
# by identity and by ten frequencies. Their local exponents steepen.
REVIEW = 1e6 * np.array([0.64, 1.28, 2.56, 5.12, 20.48])
IDENTITY = np.array([[0.289, 0.254, 0.213, 0.172, 0.109]]).T
FREQUENCIES = np.array([[0.323, 0.297, 0.261, 0.220, 0.152]]).T


def law(samples, offset=0.0, exponent=0.3):
    return offset + 0.3 * (np.asarray(samples) / SAMPLES[0]) ** -exponent


def noisy(seed, spread=0.02, samples=SAMPLES, **of):
    noise = np.random.default_rng(seed).normal(0, spread, (len(samples), 3))
    return Curve(samples, law(samples, **of)[:, None] * np.exp(noise))


@pytest.mark.parametrize(
    ("offset", "exponent"), [(0, 0.05), (0, 0.3127), (0, 1), (0.05, 0.42), (0.1, 0.813)]
)
def test_a_law_without_noise_is_found(offset, exponent):
    curve = noisy(1, spread=1e-8, offset=offset, exponent=exponent)
    found = power_law.fit(curve)
    assert (found.offset, found.exponent) == pytest.approx((offset, exponent), abs=2e-4)
    np.testing.assert_allclose(found(BEYOND), law(BEYOND, offset, exponent), rtol=1e-3)
    exponents = power_law.local_exponents(curve)
    if offset:
        assert (np.diff(exponents) < 0).all() and exponents[0] < exponent
    else:
        np.testing.assert_allclose(exponents, exponent, atol=1e-6)


def test_a_curve_that_does_not_fall_is_constant():
    flat = Curve(SAMPLES, np.full((5, 3), 0.04))  # a shadow map: it does not learn
    assert power_law.fit(flat)(BEYOND) == pytest.approx(0.04)
    assert power_law.extrapolate(flat, BEYOND, 1) == pytest.approx((0.04, 0.04, 0.04))


def test_the_first_four_budgets_of_the_review_miss_the_fifth_by_14_percent():
    # A straight line through the logarithms misses by 13.9 and 14.5 %.
    for values in (IDENTITY, FREQUENCIES):
        held = power_law.hold_out(Curve(REVIEW, values), seed=1)
        assert held.error == pytest.approx(0.14, abs=0.005)
        assert held.measured == values[-1, 0]
        assert np.isnan([held.low, held.high]).all()  # of one seed
        assert held.step == REVIEW[-1] / REVIEW[-2] == 4
    exponents = power_law.local_exponents(Curve(REVIEW, IDENTITY))
    np.testing.assert_allclose(exponents[[0, -1]], [0.19, 0.33], atol=0.005)
    # Three seeds that differ as ours do, by 1 %, do not hide a miss of 14 %.
    seeds = Curve(REVIEW, IDENTITY * np.exp([[-0.01, 0.0, 0.01]]))
    assert power_law.hold_out(seeds, seed=1).high < 1.2 * IDENTITY[-1]
    allowed, why = power_law.licensed([seeds], 2 * REVIEW[-1], seed=1)
    assert (allowed, why) == (False, "the hold-out is missed by +13.9 %, outside its interval")


@pytest.mark.parametrize("of", [{}, {"offset": 0.1, "exponent": 0.5}])
def test_intervals_hold_what_they_predict_nine_times_in_ten(of):
    held, beyond = 0, 0
    for seed in range(150):
        curve = noisy(1000 + seed, **of)
        found = power_law.hold_out(curve, seed)
        held += found.low <= found.measured <= found.high
        _, low, high = power_law.extrapolate(curve, BEYOND, seed)
        beyond += low <= law(BEYOND, **of) <= high
    # Over 2000 both are 0.89 to 0.91; of 150 the standard deviation is 0.025.
    assert 0.82 <= held / 150 <= 0.97
    assert 0.82 <= beyond / 150 <= 0.97


def test_what_both_arms_have_in_common_cancels_in_their_difference():
    a = noisy(3)
    b = Curve(a.samples, 0.8 * a.values)
    value, low, high = power_law.extrapolate_difference(a, b, BEYOND, seed=1, psnr=True)
    assert (value, low, high) == pytest.approx(np.repeat(10 * np.log10(0.8), 3))
    plain = power_law.extrapolate_difference(a, b, BEYOND, seed=1)
    alone = power_law.extrapolate(a, BEYOND, seed=1)
    assert plain == pytest.approx(tuple(0.2 * one for one in alone))


@pytest.mark.parametrize(
    ("curve", "samples", "why"),
    [
        (noisy(1), 29 * SAMPLES[-1], ""),
        (noisy(1), 3200 * SAMPLES[-1], "3,200 times the largest budget, 30 at most"),
        (noisy(1, samples=SAMPLES[:2]), SAMPLES[-1], "2 budgets: 3 are needed"),
        (Curve(REVIEW, IDENTITY), REVIEW[-1], "one seed gives no uncertainty of the fit"),
        (Curve(SAMPLES[:3], np.zeros((3, 2))), SAMPLES[-1], "an error of 0 has no power law"),
    ],
)
def test_licence(curve, samples, why):
    assert power_law.licensed([noisy(1), curve], samples, seed=1) == (not why, why)


def test_a_dead_training_and_seeds_that_hold_any_prediction_license_nothing():
    diverged = power_law.licensed([noisy(1)], BEYOND, seed=1, diverged=True)
    assert diverged == (False, "a training diverged")
    # As in the review the last budget is missed by 14 %, within the interval of these seeds.
    wild = Curve(REVIEW, IDENTITY * np.exp([[-0.3, 0.0, 0.3]]))
    held = power_law.hold_out(wild, seed=1)
    assert held.low < held.measured < held.high
    allowed, why = power_law.licensed([wild], 2 * REVIEW[-1], seed=1)
    assert not allowed and why.endswith(" %, 10 % at most")


def test_a_map_is_a_constant_that_may_have_no_error_at_all():
    curve = noisy(1)
    value, low, high = power_law.extrapolate(curve, BEYOND, seed=1)
    for error in (0.0, 0.05):
        found = power_law.extrapolate_difference(curve, error, BEYOND, seed=1)
        assert found == pytest.approx((value - error, low - error, high - error))


def test_what_cannot_be_fitted():
    for bad in (Curve(SAMPLES[:1], np.ones((1, 3))), Curve(SAMPLES, np.zeros((5, 3)))):
        with pytest.raises(ValueError, match="two budgets or more, and errors that are positive"):
            power_law.fit(bad)
        assert not power_law.can_hold_out(bad)


def test_trend_is_of_each_tenfold_with_students_interval():
    slopes = np.array([0.5, 0.7, 0.6])
    differences = 2 + slopes * np.log10(SAMPLES)[:, None]
    half = 4.303 * 0.1 / np.sqrt(3)
    assert power_law.trend(SAMPLES, differences) == pytest.approx(
        (0.6, 0.6 - half, 0.6 + half), 1e-4
    )
    assert power_law.trend(SAMPLES, differences[:, :1]) == pytest.approx((0.5, -np.inf, np.inf))

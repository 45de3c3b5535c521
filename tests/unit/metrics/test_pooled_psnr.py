import numpy as np
import pytest

from neural_shadows.metrics.intervals import pooled_psnr_difference, pooled_psnr_interval
from neural_shadows.metrics.pooled_psnr import identical, mse_of, psnr_of
from neural_shadows.metrics.registry import error_of, value_of


def test_one_identical_frame_does_not_drive_it():
    # Squared errors 0.01, 0.03 and 1e-10: their mean is 0.01333, 18.75 dB; the mean of the PSNRs
    # would be 45.1 dB.
    psnr = np.array([20.0, -10 * np.log10(0.03), 100.0])
    assert pooled_psnr_interval(psnr, seed=1)[0] == pytest.approx(18.7506, abs=1e-4)
    assert identical(psnr) == 1
    np.testing.assert_allclose(mse_of(psnr), [0.01, 0.03, 1e-10])


def test_intervals_of_pooled_psnr():
    rng = np.random.default_rng(3)
    common = rng.lognormal(-6, 1.0, 400)  # of the views, far more than the methods differ by
    a, b = (-10 * np.log10(common * share * rng.lognormal(0, 0.1, 400)) for share in (1, 2))
    value, low, high = pooled_psnr_interval(a, seed=1)
    error = common.std() / common.mean() / 20 * 10 / np.log(10)  # delta method, dB
    assert value == pytest.approx(psnr_of(mse_of(a).mean()))
    assert high - low == pytest.approx(2 * 1.96 * error, rel=0.15)
    difference, low, high = pooled_psnr_difference(a, b, seed=1)
    assert difference == pytest.approx(psnr_of(mse_of(a).mean() / mse_of(b).mean()))
    # Twice the squared error is 3.01 dB. Without pairing the width would be 5.5 errors.
    assert low < 10 * np.log10(2) < high
    assert high - low < error


def test_errors_and_back():
    values = np.array([0.1, 0.9])
    for metric in ("loss", "lpips", "psnr", "ssim"):
        np.testing.assert_allclose(value_of(metric, error_of(metric, values)), values)
    assert error_of("psnr", 20.0) == pytest.approx(0.01)
    assert error_of("ssim", 0.9) == pytest.approx(0.1)

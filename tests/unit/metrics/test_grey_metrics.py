"""PSNR and SSIM against formulas, FLIP against its authors' package; shadow errors."""

import flip_evaluator
import numpy as np
import pytest
from images import constant, random_image

from neural_shadows.metrics.kinds.errors_of_visibility import shadow_error
from neural_shadows.metrics.kinds.flip import flip, flip_map
from neural_shadows.metrics.kinds.psnr import psnr
from neural_shadows.metrics.kinds.ssim import ssim


def test_psnr():
    image = 0.5 * random_image(0)
    for offset, decibels in [(0.1, 20.0), (0.01, 40.0), (0.5, 6.0206)]:
        assert psnr(image + np.float32(offset), image) == pytest.approx(decibels, abs=1e-3)
    assert psnr(constant(0.5 + 1e-6), constant(0.5)) == 100.0  # 120 dB, but for the cap


def test_ssim_is_that_of_wang_2004():
    image, reference = random_image(0), random_image(1)
    # The paper's formula with its 11 x 11 window, written out for one pixel.
    window = np.exp(-(np.arange(-5, 6) ** 2) / (2 * 1.5**2))
    window = np.outer(window, window) / window.sum() ** 2
    x, y = image[:11, :11].astype(float), reference[:11, :11].astype(float)
    mean_x, mean_y = (window * x).sum(), (window * y).sum()
    variance_x = (window * (x - mean_x) ** 2).sum()
    variance_y = (window * (y - mean_y) ** 2).sum()
    covariance = (window * (x - mean_x) * (y - mean_y)).sum()
    c1, c2 = 0.01**2, 0.03**2
    expected = ((2 * mean_x * mean_y + c1) * (2 * covariance + c2)) / (
        (mean_x**2 + mean_y**2 + c1) * (variance_x + variance_y + c2)
    )
    assert ssim(image[:11, :11], reference[:11, :11]) == pytest.approx(expected, abs=1e-5)


def shadowed() -> np.ndarray:
    """A ground that darkens to a side, with a slanted shadow."""
    y, x = np.mgrid[:150, :200].astype(np.float32)
    return np.where(abs(x - y) < 30, 0.25, 0.4 + 0.002 * x).astype(np.float32)


PAIRS = {
    "a shadow moved by a pixel": (np.roll(shadowed(), 1, axis=1), shadowed(), 2e-6),
    "random": (random_image(0, (75, 131)), random_image(1, (75, 131)), 5e-6),
    "0 and 1": (random_image(2).round(), random_image(3).round(), 5e-6),
    "smaller than a filter": (random_image(4, (5, 7)), random_image(5, (5, 7)), 5e-6),
    # The package takes the root of its derivatives' rounding errors.
    "flat": (constant(0.3), constant(0.5), 2e-5),
    "black and white": (constant(0.0), constant(1.0), 2e-5),
}


@pytest.mark.parametrize("pair", PAIRS)
def test_flip_is_that_of_the_package(pair):
    image, reference, tolerance = PAIRS[pair]
    colored = (np.repeat(grey[..., None], 3, axis=2) for grey in (reference, image))
    expected, _, _ = flip_evaluator.evaluate(
        *colored, "LDR", applyMagma=False, computeMeanError=False
    )
    assert flip(image, reference) == pytest.approx(expected.mean(dtype=np.float64), abs=tolerance)
    np.testing.assert_allclose(flip_map(image, reference), expected[..., 0], rtol=0, atol=1e-3)
    assert flip(image, image) == 0


@pytest.mark.parametrize("metric", [psnr, ssim, flip])
@pytest.mark.parametrize("wrong", [constant(np.nan), constant(255.0), constant(0.5, (1, 80))])
def test_what_is_no_grey_image_is_refused(metric, wrong):
    with pytest.raises(ValueError, match="grey|\\[0, 1\\]"):
        metric(wrong, constant(0.5))


def test_shadow_error():
    #                       fine fine dark dark leak penumbra
    visibility = np.float32([1, 0, 0, 0, 1, 0.25])
    reference = np.float32([1, 0, 1, 1, 0, 0.75])
    assert shadow_error(visibility, reference) == (3.5 / 6, 2.5 / 6, 1 / 6)

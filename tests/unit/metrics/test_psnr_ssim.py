import numpy as np
import pytest
from images import constant, random_image

from neural_shadows.metrics.flip import flip
from neural_shadows.metrics.psnr_ssim import psnr, ssim


def test_psnr():
    image = 0.5 * random_image(0)
    for offset, decibels in [(0.1, 20.0), (0.01, 40.0), (0.5, 6.0206)]:
        assert psnr(image + np.float32(offset), image) == pytest.approx(decibels, abs=1e-3)
    assert psnr(image, image) == 100.0
    assert psnr(constant(0.5 + 1e-6), constant(0.5)) == 100.0  # 120 dB, but for the cap


@pytest.mark.parametrize(("a", "b"), [(0.3, 0.7), (0.0, 1.0), (0.25, 0.26)])
def test_ssim_of_constants(a, b):
    expected = (2 * a * b + 0.01**2) / (a**2 + b**2 + 0.01**2)
    assert ssim(constant(a), constant(b)) == pytest.approx(expected, abs=1e-6)


def test_ssim_is_that_of_wang_2004():
    image, reference = random_image(0), random_image(1)
    assert ssim(image, image) == 1.0

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


@pytest.mark.parametrize("metric", [psnr, ssim, flip])
@pytest.mark.parametrize(
    "image",
    [
        constant(np.nan),
        constant(255.0),
        constant(-0.1),
        constant(0.5, (1, 80)),
        constant(0.5, (64, 80, 3)),
    ],
    ids=["nan", "bytes", "negative", "broadcasts", "rgb"],
)
def test_what_is_no_grey_image_is_refused(metric, image):
    with pytest.raises(ValueError, match="grey|\\[0, 1\\]"):
        metric(image, constant(0.5))

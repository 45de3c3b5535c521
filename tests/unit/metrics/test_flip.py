"""Grey FLIP against the paper's closed form and against the general package."""

import flip_evaluator
import numpy as np
import pytest
from images import NO_GREY_IMAGES, constant, random_image
from skimage.color import rgb2lab

from neural_shadows.metrics.flip import Flip


def hunt(rgb: tuple[float, float, float]) -> np.ndarray:
    """L*a*b* of one sRGB colour, chroma scaled by the Hunt effect (FLIP, section 4.1.2)."""
    lightness, a, b = rgb2lab(np.array(rgb, float))
    return np.array([lightness, 0.01 * lightness * a, 0.01 * lightness * b])


@pytest.mark.parametrize(("a", "b"), [(0.0, 1.0), (0.3, 0.5), (0.2, 0.22)])
def test_flip_of_constants(a, b):
    """Flat greys differ in lightness alone: the paper has a closed form (0.967 for 0, 1)."""

    def hyab(p, q):
        return abs(p[0] - q[0]) + np.hypot(p[1] - q[1], p[2] - q[2])

    largest = hyab(hunt((0, 1, 0)), hunt((0, 0, 1))) ** 0.7
    error = hyab(hunt((a, a, a)), hunt((b, b, b))) ** 0.7 / largest
    expected = 0.95 * error / 0.4 if error < 0.4 else 0.95 + 0.05 * (error - 0.4) / 0.6
    assert Flip(constant(b)).mean(constant(a)) == pytest.approx(expected, abs=1e-4)
    assert Flip(constant(a)).mean(constant(b)) == pytest.approx(expected, abs=1e-4)


def disk(radius: float, x: float, y: float, shape: tuple[int, int] = (120, 160)) -> np.ndarray:
    """A bright disk on a dark ground, of the greys that shading gives."""
    rows, columns = np.indices(shape)
    return np.where(np.hypot(rows - y, columns - x) < radius, 0.85, 0.25).astype(np.float32)


def general(image: np.ndarray, reference: np.ndarray) -> np.ndarray:
    """The package's error map of the grey images as RGB."""
    pair = (np.repeat(grey[..., None], 3, axis=2) for grey in (reference, image))
    return flip_evaluator.evaluate(*pair, "LDR", applyMagma=False, computeMeanError=False)[0][
        ..., 0
    ]


@pytest.mark.parametrize(
    ("image", "reference"),
    [
        pytest.param(disk(40, 83, 58), disk(42, 80, 60), id="moved disk"),
        pytest.param(random_image(0), random_image(1), id="noise"),
        pytest.param(disk(20, 60, 60), random_image(2, (120, 160)), id="disk and noise"),
        pytest.param(constant(0.5) + 0.1 * random_image(3), constant(0.5), id="faint noise"),
        pytest.param(constant(0.0), constant(1.0), id="black and white"),
        pytest.param(random_image(4, (9, 7)), random_image(5, (9, 7)), id="below the kernels"),
    ],
)
def test_flip_is_the_packages(image, reference):
    error, expected = Flip(reference).error_map(image), general(image, reference)
    assert error.shape == expected.shape
    assert error.dtype == np.float32
    # Rounding in L* of nearly equal pixels, raised to 0.7: up to 0.003 at single pixels.
    np.testing.assert_allclose(error, expected, atol=0.005)
    assert error.mean(dtype=np.float64) == pytest.approx(expected.mean(dtype=np.float64), rel=3e-4)


def test_flip_of_identical_frames_is_zero():
    assert Flip(random_image(0)).mean(random_image(0)) == 0.0


def test_flip_is_symmetric():
    a, b = random_image(0), random_image(1)
    assert 0.1 < Flip(b).mean(a) == pytest.approx(Flip(a).mean(b), abs=1e-5)


def test_error_map_shows_where():
    reference = constant(0.5)
    image = reference.copy()
    image[:, 60:] = 1.0
    flip = Flip(reference)
    error = flip.error_map(image)
    assert error[:, :40].max() < 1e-3
    assert error[:, 65:].min() > 0.3
    assert flip.mean(image) == pytest.approx(error.mean(dtype=np.float64))


@pytest.mark.parametrize("image", NO_GREY_IMAGES)
def test_what_is_no_grey_image_is_refused(image):
    with pytest.raises(ValueError, match="grey|\\[0, 1\\]"):
        Flip(constant(0.5)).mean(image)
    if image.shape != (1, 80):
        with pytest.raises(ValueError, match="grey|\\[0, 1\\]"):
            Flip(image)

import numpy as np
import pytest
from images import constant, random_image
from skimage.color import rgb2lab

from neural_shadows.metrics.flip import flip, flip_map


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
    assert flip(constant(a), constant(b)) == pytest.approx(expected, abs=1e-4)
    assert flip(constant(b), constant(a)) == pytest.approx(expected, abs=1e-4)


def test_error_map_shows_where():
    reference = random_image(0)
    assert flip(reference, reference) == 0.0
    image = reference.copy()
    image[:, 60:] = 1 - image[:, 60:]
    error = flip_map(image, reference)
    assert error.shape == reference.shape and error.dtype == np.float32
    assert error[:, :40].max() == 0 and error[:, 65:].mean() > 0.1
    assert flip(image, reference) == pytest.approx(error.mean(dtype=np.float64))

"""Open Image Denoise on flat pictures; without the package, what says how to get it."""

import sys

import numpy as np
import pytest

from neural_shadows.denoising import oidn
from neural_shadows.errors import InputError

HEIGHT, WIDTH = 64, 96


@pytest.fixture
def normal():
    pytest.importorskip("pyoidn", reason="no pyoidn for this machine")
    normal = np.zeros((HEIGHT, WIDTH, 3), np.float32)
    normal[:, :, 2] = 1
    return normal


@pytest.mark.parametrize("light", [0.25, 0.5, oidn.ANY_RANGE])
def test_what_has_no_noise_stays_and_no_buffer_is_handed_out(normal, light):
    lit, dark = (np.full((HEIGHT, WIDTH), value, np.float32) for value in (1, 0))
    first = oidn.open_image_denoise(lit, normal, light=light)
    # A network: not exact, least of all in a corner.
    assert np.mean(1 - first) < 5e-3 and first.min() > 0.9
    assert oidn.open_image_denoise(dark, normal, light=light).max() < 0.01
    assert first.min() > 0.9


def test_the_value_of_full_light_matters(normal):
    rays = (np.random.default_rng(1).random((HEIGHT, WIDTH)) < 0.6).astype(np.float32)
    a, b, c = (oidn.open_image_denoise(rays, normal, light=light) for light in (0.25, 0.85, 0.0))
    for one, other in ((a, b), (a, c), (b, c)):
        assert np.abs(one - other).mean() > 1e-3


def test_without_the_package(monkeypatch):
    monkeypatch.setitem(sys.modules, "pyoidn", None)
    normal = np.zeros((3, 5, 3), np.float32)
    with pytest.raises(InputError, match="^Open Image Denoise is not installed .pyoidn"):
        oidn.open_image_denoise(normal[..., 0], normal)

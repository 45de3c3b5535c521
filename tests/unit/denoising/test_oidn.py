"""Open Image Denoise on noise whose mean is known; without the package, what says how to get it."""

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


@pytest.mark.parametrize("quality", oidn.QUALITIES)
def test_a_noisy_penumbra(normal, quality):
    truth = np.broadcast_to(np.clip((np.arange(WIDTH) - 16) / 64, 0, 1), (HEIGHT, WIDTH))
    noisy = (np.random.default_rng(0).random((2, HEIGHT, WIDTH)) < truth).mean(0, np.float32)
    found = oidn.open_image_denoise(noisy, normal, quality=quality)
    assert found.shape == truth.shape and found.dtype == np.float32
    assert found.min() >= 0 and found.max() <= 1
    assert 15 * np.mean((found - truth) ** 2) < np.mean((noisy - truth) ** 2)
    # Penumbrae get no brighter than they are.
    assert abs(np.mean(found - truth)) < 0.02


def test_what_has_no_noise_stays_and_no_buffer_is_handed_out(normal):
    lit, dark = (np.full((HEIGHT, WIDTH), value, np.float32) for value in (1, 0))
    first = oidn.open_image_denoise(lit, normal)
    # A network: not exact, least of all in a corner.
    assert np.mean(1 - first) < 5e-3 and first.min() > 0.9
    assert oidn.open_image_denoise(dark, normal).max() < 0.01
    assert first.min() > 0.9


def test_without_the_package(monkeypatch):
    monkeypatch.setitem(sys.modules, "pyoidn", None)
    normal = np.zeros((3, 5, 3), np.float32)
    with pytest.raises(InputError, match="^Open Image Denoise is not installed .pyoidn"):
        oidn.open_image_denoise(normal[..., 0], normal)

"""Open Image Denoise on flat pictures; without the package, what says how to get it."""

import sys

import numpy as np
import pytest

from neural_shadows.denoising import oidn
from neural_shadows.errors import InputError

HEIGHT, WIDTH = 64, 96


DEPTH = np.broadcast_to(np.linspace(2, 9, WIDTH, dtype=np.float32), (HEIGHT, WIDTH))


@pytest.fixture
def normal():
    pytest.importorskip("pyoidn", reason="no pyoidn for this machine")
    normal = np.zeros((HEIGHT, WIDTH, 3), np.float32)
    normal[:, :, 2] = 1
    return normal


@pytest.mark.parametrize("light", [0.25, 0.5, oidn.ANY_RANGE])
def test_what_has_no_noise_stays_and_no_buffer_is_handed_out(normal, light):
    lit, dark = (np.full((HEIGHT, WIDTH), value, np.float32) for value in (1, 0))
    first = oidn.open_image_denoise(lit, normal, DEPTH, light=light)
    # A network: not exact, least of all in a corner.
    assert np.mean(1 - first) < 5e-3 and first.min() > 0.85
    assert oidn.open_image_denoise(dark, normal, DEPTH, light=light).max() < 0.01
    assert first.min() > 0.85


def test_the_value_of_full_light_matters(normal):
    rays = (np.random.default_rng(1).random((HEIGHT, WIDTH)) < 0.6).astype(np.float32)
    a, b, c = (
        oidn.open_image_denoise(rays, normal, DEPTH, light=light) for light in (0.25, 0.85, 0.0)
    )
    for one, other in ((a, b), (a, c), (b, c)):
        assert np.abs(one - other).mean() > 1e-3


def test_depths_are_logarithms_from_0_to_1():
    """A step of one factor is one step; where there is no surface nothing counts."""
    depth = np.float32([[1, 2, 4, 0], [1, 4, 2, 100]])
    surface = np.array([[True, True, True, False]] * 2)
    assert np.allclose(oidn._shares(depth, surface), [[0, 0.5, 1, 0], [0, 1, 0.5, 0]])
    for flat in (surface, surface & False):
        assert np.all(oidn._shares(np.full((2, 4), 3, np.float32), flat) == 0)


def test_without_the_package(monkeypatch):
    monkeypatch.setitem(sys.modules, "pyoidn", None)
    normal = np.zeros((3, 5, 3), np.float32)
    with pytest.raises(InputError, match="^Open Image Denoise is not installed .pyoidn"):
        oidn.open_image_denoise(normal[..., 0], normal, normal[..., 0])

"""Grey images for the tests of metrics, and what is none."""

import numpy as np
import pytest


def random_image(seed: int, shape: tuple[int, int] = (64, 80)) -> np.ndarray:
    return np.random.default_rng(seed).random(shape, np.float32)


def constant(value: float, shape: tuple[int, int] = (64, 80)) -> np.ndarray:
    return np.full(shape, value, np.float32)


NO_GREY_IMAGES = [
    pytest.param(constant(np.nan), id="nan"),
    pytest.param(constant(255.0), id="byte-range"),
    pytest.param(constant(-0.1), id="negative"),
    pytest.param(constant(0.5, (1, 80)), id="broadcasts"),
    pytest.param(np.zeros((64, 80, 3), np.float32), id="rgb"),
]

"""Grey images for the tests of metrics."""

import numpy as np


def random_image(seed: int, shape: tuple[int, ...] = (64, 80)) -> np.ndarray:
    return np.random.default_rng(seed).random(shape, np.float32)


def constant(value: float, shape: tuple[int, ...] = (64, 80)) -> np.ndarray:
    return np.full(shape, value, np.float32)

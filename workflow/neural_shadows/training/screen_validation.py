"""Errors of screen-space networks on frames outside the training."""

from collections.abc import Callable
from functools import partial

import numpy as np
import torch

from neural_shadows.training.screen_batches import ScreenFrames
from neural_shadows.training.screen_run import ScreenRun

Predictor = Callable[[int, int], np.ndarray]
"""Visibility (H, W) float32 of a frame and a radius, by their indices."""


def network_predictor(run: ScreenRun, frames: ScreenFrames) -> Predictor:
    """Predict by a run's network, clamped to [0, 1]."""

    def predict(frame: int, radius: int) -> np.ndarray:
        features = torch.from_numpy(frames.features(frame, radius))[None].to(run.device)
        with torch.no_grad():  # not inherited by a pool's threads
            return run.predict(features)[0, 0].clamp(0, 1).cpu().numpy()

    return predict


def null_predictors(frames: ScreenFrames) -> dict[str, Predictor]:
    """Null predictors: all lit, the unfiltered light map, and the bases.

    The light map only if the frames have it, as a user's own need not.
    """
    lit = np.ones((frames.height, frames.width), np.float32)

    def shadow(name: str, frame: int, radius: int) -> np.ndarray:
        return frames.base(name, frame)

    predictors: dict[str, Predictor] = {"no_shadow": lambda frame, radius: lit}
    if "hard" in frames.about["channels"]:
        predictors["hard_map"] = partial(shadow, "base_hard")
    return predictors | {name: partial(shadow, name) for name in frames.bases}


def mse_by_radius(
    frames: ScreenFrames, predict: Predictor, compute: Callable = map, every: int = 1
) -> list[float | None]:
    """Mean squared error over valid pixels, for each radius; None if not finite.

    Args:
        compute: `map`, or a pool's.
        every: step between frames.
    """
    numbers = range(0, len(frames), every)
    images = [(frame, radius) for radius in range(frames.radii) for frame in numbers]

    def error(image: tuple[int, int]) -> tuple[float, int]:
        valid = frames.valid(image[0])
        difference = (predict(*image) - frames.target(*image))[valid]
        return float(np.square(difference, dtype=np.float64).sum()), int(valid.sum())

    sums = np.array([*compute(error, images)]).reshape(frames.radii, len(numbers), 2).sum(1)
    errors = sums[:, 0] / np.maximum(sums[:, 1], 1)
    return [value if np.isfinite(value) else None for value in errors.tolist()]

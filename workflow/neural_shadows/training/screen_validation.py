"""Errors of screen-space networks on frames outside the training."""

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np
import torch

from neural_shadows.training.screen_batches import ScreenFrames
from neural_shadows.training.screen_run import ScreenRun

Image = tuple[int, int]
"""A frame and a radius, by their indices."""

Predictor = Callable[[int, int], np.ndarray]
"""Visibility (H, W) float32 of an `Image`."""


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
        return frames.base(name, frame, radius)

    predictors: dict[str, Predictor] = {"no_shadow": lambda frame, radius: lit}
    if "hard" in frames.about["channels"]:
        predictors["hard_map"] = partial(shadow, "base_hard")
    return predictors | {name: partial(shadow, name) for name in frames.bases}


def spread_images(frames: ScreenFrames, most: int) -> list[Image]:
    """Images evenly spread over frames and lights, by radius.

    All of them if there are no more than `most`; else the lights have different frames, and each as
    many, one at least.
    """
    each = min(len(frames), max(1, most // frames.radii))
    count = each * frames.radii
    return [
        ((number * frames.radii + radius) * len(frames) // count, radius)
        for radius in range(frames.radii)
        for number in range(each)
    ]


def null_errors(
    frames: ScreenFrames, images: Sequence[Image], compute: Callable = map
) -> dict[str, list[float | None]]:
    """`mse_by_radius` of `null_predictors`."""
    nulls = null_predictors(frames).items()
    return {name: mse_by_radius(frames, null, images, compute) for name, null in nulls}


def mse_by_radius(
    frames: ScreenFrames, predict: Predictor, images: Sequence[Image], compute: Callable = map
) -> list[float | None]:
    """Mean squared error over valid pixels, for each radius; None if not finite.

    Args:
        images: of `spread_images`.
        compute: `map`, or a pool's.
    """

    def error(image: Image) -> tuple[float, int]:
        valid = frames.valid(image[0])
        difference = (predict(*image) - frames.target(*image))[valid]
        return float(np.square(difference, dtype=np.float64).sum()), int(valid.sum())

    sums = np.array([*compute(error, images)]).reshape(frames.radii, -1, 2).sum(1)
    errors = sums[:, 0] / np.maximum(sums[:, 1], 1)
    return [value if np.isfinite(value) else None for value in errors.tolist()]

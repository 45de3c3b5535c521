"""How far screen-space networks are from the exact soft shadows of frames that none trains on."""

from collections.abc import Callable
from functools import partial

import numpy as np
import torch

from neural_shadows.training.screen_batches import ScreenFrames
from neural_shadows.training.screen_run import ScreenRun

Answer = Callable[[int, int], np.ndarray]
"""Visibility (H, W) float32 of a frame and a radius, by their indices."""


def network_answer(run: ScreenRun, frames: ScreenFrames) -> Answer:
    """What a run's network says, cut off to [0, 1]."""

    def answer(frame: int, radius: int) -> np.ndarray:
        features = torch.from_numpy(frames.features(frame, radius))[None].to(run.device)
        with torch.no_grad():  # which a pool's threads do not inherit
            return run.answer(features)[0, 0].clamp(0, 1).cpu().numpy()

    return answer


def null_answers(frames: ScreenFrames) -> dict[str, Answer]:
    """What answers without learning: that all is lit, the light's map, unfiltered, if the frames hold
    it, as a user's own need not, and what the network is given as its base.
    """
    lit = np.ones((frames.height, frames.width), np.float32)

    def shadow(name: str, frame: int, radius: int) -> np.ndarray:
        return frames.base(name, frame)

    answers: dict[str, Answer] = {"no_shadow": lambda frame, radius: lit}
    if "hard" in frames.about["channels"]:
        answers["hard_map"] = partial(shadow, "base_hard")
    return answers | {name: partial(shadow, name) for name in frames.bases}


def mse_by_radius(
    frames: ScreenFrames, answer: Answer, compute: Callable = map, every: int = 1
) -> list[float | None]:
    """Mean squared error over the valid pixels of the frames, for each radius; None if no number.

    Args:
        compute: `map`, or that of a pool.
        every: only each frame of so many.
    """
    chosen = range(0, len(frames), every)
    asked = [(frame, radius) for radius in range(frames.radii) for frame in chosen]

    def error(place: tuple[int, int]) -> tuple[float, int]:
        valid = frames.valid(place[0])
        off = (answer(*place) - frames.target(*place))[valid]
        return float(np.square(off, dtype=np.float64).sum()), int(valid.sum())

    sums = np.array([*compute(error, asked)]).reshape(frames.radii, len(chosen), 2).sum(1)
    found = sums[:, 0] / np.maximum(sums[:, 1], 1)
    return [value if np.isfinite(value) else None for value in found.tolist()]

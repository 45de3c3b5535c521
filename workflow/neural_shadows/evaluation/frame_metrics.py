"""Metrics of frames under an area light, and flicker."""

import numpy as np

from neural_shadows.evaluation.flicker import flicker as flicker
from neural_shadows.evaluation.measured_frames import MeasuredFrame
from neural_shadows.metrics.registry import OfImages, image_metrics, measure

LIGHT = "soft"


def metrics(
    frame: MeasuredFrame, visibility: np.ndarray, radius: int, images: OfImages
) -> dict[str, float]:
    """Errors and image metrics.

    Slow ones are of a part's first frame by the middle light: they take 0.15 CPU s of a picture of
    512 × 256, where the errors take 0.01.
    """
    if frame.number or radius != frame.middle:
        images = image_metrics(LIGHT, slow=False)
    values = image_errors(frame, visibility, radius, images)
    if frame.blocks is not None:
        target, blocks = frame.target[radius], frame.blocks.astype(np.float32)
        values |= measure("of_occluders", LIGHT, visibility, target, frame.valid, *blocks)
    return values


def image_errors(
    frame: MeasuredFrame, visibility: np.ndarray, radius: int, images: OfImages
) -> dict[str, float]:
    """Errors and metrics of one image.

    Image metrics see the target at invalid pixels.
    """
    target = frame.target[radius]
    return {
        **measure("of_visibility", LIGHT, visibility, target, frame.pixels),
        **images(np.where(frame.valid, visibility, target), target),
    }

"""Metrics of a view by a method."""

import numpy as np

from neural_shadows.evaluation.views import View
from neural_shadows.metrics.metric import Pixels
from neural_shadows.metrics.registry import OfImages, measure
from neural_shadows.rendering.shading import shade

LIGHT = "hard"


def metrics(view: View, visibility: np.ndarray, radius: int, images: OfImages) -> dict[str, float]:
    """Image metrics and errors of visibility."""
    image, reference = shade(view.frame, visibility), shade(view.frame, view.reference)
    pixels = Pixels(np.ones(len(view.reference), bool))
    return {
        **images(image, reference),
        **measure("of_visibility", LIGHT, visibility, view.reference, pixels),
    }

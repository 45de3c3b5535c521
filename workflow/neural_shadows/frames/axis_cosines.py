"""Distances along a camera's axis, from those along the ways of its pixels."""

import numpy as np

from neural_shadows.rendering.gbuffer import pixel_directions
from neural_shadows.scenes.cameras import Camera


def axis_cosines(camera: Camera, width: int, height: int) -> np.ndarray:
    """Cosine of each pixel's way with the camera's axis, (height, width) float32.

    It depends on the camera's field of view and window alone.
    """
    ways = pixel_directions(camera, width, height)  # 1 long along the axis
    return (1 / np.linalg.norm(ways, axis=1)).reshape(height, width)

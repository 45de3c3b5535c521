"""Alignment of a frame with a perturbed frame (Hu et al. 2025, 4.2.2)."""

from collections.abc import Mapping

import numpy as np

from neural_shadows.rendering.gbuffer import axis_cosines, pixel_directions
from neural_shadows.rendering.reprojection import NORMAL_DISTANCE, projected
from neural_shadows.scenes.cameras import Camera

ALIGNED_BY = ("d", "n_x", "n_y", "n_z")  # buffers
_DEPTH_DISTANCE = 0.07  # in shares of the scene's size, of its code; beyond it another surface


def twin_pixels(
    camera: Camera,
    buffers: Mapping[str, np.ndarray],
    twin_camera: Camera,
    twin_buffers: Mapping[str, np.ndarray],
    size: float,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Find the perturbed frame's nearest pixel for each pixel's point.

    Args:
        buffers, twin_buffers: `ALIGNED_BY`, images (H, W). size: of the scene, in metres.

    Returns:
        (H, W) bool, True where that pixel is in the image and shows the same surface; its rows and
        columns, (H, W) int64, 0 outside the image.
    """
    height, width = buffers["d"].shape
    directions = pixel_directions(camera, width, height)
    distances = size * buffers["d"] * axis_cosines(camera, width, height)  # along the axis
    points = camera.eye + distances.reshape(-1, 1) * directions
    column, row, depth = projected(twin_camera, width, height, points)
    row, column = np.floor(row + 0.5), np.floor(column + 0.5)
    inside = (depth > 0) & (row >= 0) & (row < height) & (column >= 0) & (column < width)
    row, column = (np.where(inside, index, 0).astype(np.int64) for index in (row, column))
    eye_distances = np.linalg.norm(points - twin_camera.eye, axis=1) / size
    same = np.abs(twin_buffers["d"][row, column] - eye_distances) < _DEPTH_DISTANCE
    normal_differences = [
        twin_buffers[name][row, column] - buffers[name].ravel() for name in ("n_x", "n_y", "n_z")
    ]
    same &= np.linalg.norm(normal_differences, axis=0) < NORMAL_DISTANCE
    return tuple(image.reshape(height, width) for image in (inside & same, row, column))

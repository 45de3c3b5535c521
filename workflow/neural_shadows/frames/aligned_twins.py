"""Where a frame's twin shows what the frame shows (Hu et al. 2025, 4.2.2)."""

from collections.abc import Mapping

import numpy as np

from neural_shadows.rendering.gbuffer import axis_cosines, pixel_directions
from neural_shadows.rendering.reprojection import NORMAL_DISTANCE, projected
from neural_shadows.scenes.cameras import Camera

ALIGNED_BY = ("d", "n_x", "n_y", "n_z")  # buffers
_DEPTH_DISTANCE = 0.07  # in shares of the scene's size, of its code: farther off is another surface


def twin_pixels(
    camera: Camera,
    buffers: Mapping[str, np.ndarray],
    twin_camera: Camera,
    twin_buffers: Mapping[str, np.ndarray],
    size: float,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The twin's pixel that is nearest to where it sees the point that a pixel shows.

    Args:
        buffers, twin_buffers: `ALIGNED_BY`, images (H, W). size: of the scene, in metres.

    Returns:
        (H, W) bool, whether that pixel is in the image and shows the same surface; its rows and its
        columns, (H, W) int64, 0 outside of the image.
    """
    height, width = buffers["d"].shape
    ways = pixel_directions(camera, width, height)
    distances = size * buffers["d"] * axis_cosines(camera, width, height)  # along the axis
    points = camera.eye + distances.reshape(-1, 1) * ways
    column, row, depth = projected(twin_camera, width, height, points)
    row, column = np.floor(row + 0.5), np.floor(column + 0.5)
    inside = (depth > 0) & (row >= 0) & (row < height) & (column >= 0) & (column < width)
    row, column = (np.where(inside, one, 0).astype(np.int64) for one in (row, column))
    away = np.linalg.norm(points - twin_camera.eye, axis=1) / size
    same = np.abs(twin_buffers["d"][row, column] - away) < _DEPTH_DISTANCE
    turned = [
        twin_buffers[name][row, column] - buffers[name].ravel() for name in ("n_x", "n_y", "n_z")
    ]
    same &= np.linalg.norm(turned, axis=0) < NORMAL_DISTANCE
    return tuple(one.reshape(height, width) for one in (inside & same, row, column))

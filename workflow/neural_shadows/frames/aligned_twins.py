"""Alignment of a frame with a perturbed frame (Hu et al. 2025, 4.2.2)."""

from collections.abc import Mapping

import numpy as np

from neural_shadows.rendering.gbuffer import pixel_directions
from neural_shadows.rendering.reprojection import NORMAL_DISTANCE, on_image
from neural_shadows.scenes.cameras import Camera, camera_axes

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
    # By component: numpy is several times slower along a last axis of 3.
    directions = np.ascontiguousarray(pixel_directions(camera, width, height).T)
    distances = size * buffers["d"].ravel() / np.linalg.norm(directions, axis=0)  # along the axis
    points = (camera.eye - twin_camera.eye)[:, None] + distances * directions
    axes = camera_axes(twin_camera.eye, twin_camera.target, twin_camera.up)
    # `@` would wake threads of BLAS: 8 ms of 256 × 256 pixels instead of 0.2.
    along_axes = np.einsum("ij,jn->in", axes, points)
    column, row, depth = on_image(twin_camera, width, height, along_axes)
    row, column = np.floor(row + 0.5), np.floor(column + 0.5)
    inside = (depth > 0) & (row >= 0) & (row < height) & (column >= 0) & (column < width)
    pixel = np.where(inside, row * width + column, 0).astype(np.int64)
    eye_distances = np.linalg.norm(points, axis=0) / size
    same = np.abs(twin_buffers["d"].ravel()[pixel] - eye_distances) < _DEPTH_DISTANCE
    normal_differences = [
        twin_buffers[name].ravel()[pixel] - buffers[name].ravel() for name in ("n_x", "n_y", "n_z")
    ]
    same &= np.linalg.norm(normal_differences, axis=0) < NORMAL_DISTANCE
    return tuple(
        image.reshape(height, width) for image in (inside & same, *np.divmod(pixel, width))
    )

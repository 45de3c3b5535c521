"""Reprojection to the previous frame, for instability and temporal filters."""

import numpy as np
from scipy.ndimage import map_coordinates

from neural_shadows.rendering.surface import Surface
from neural_shadows.scenes.cameras import Window, camera_axes

DEPTH_SHARE, NORMAL_DISTANCE = 0.02, 0.4  # thresholds of another surface
LEAST_WEIGHT = 1e-3  # least weight of a pixel that must agree


def projected(camera, width: int, height: int, points: np.ndarray) -> np.ndarray:
    """Project points (n, 3): column, row and depth along the axis, (3, n).

    Columns and rows in pixels; a pixel's centre has whole numbers.
    """
    axes = camera_axes(camera.eye, camera.target, camera.up)
    return on_image(camera, width, height, axes @ (points - camera.eye).T.astype(np.float64))


def on_image(camera, width: int, height: int, along_axes: np.ndarray) -> np.ndarray:
    """`projected` from coordinates along the camera's axes, (3, n)."""
    right, upward, forward = along_axes
    whole = camera.window or Window(width, height, 0, 0)
    with np.errstate(divide="ignore", invalid="ignore"):
        scale = camera.focal(height) / forward
    column = whole.full_width / 2 + scale * right - 0.5 - whole.left
    row = whole.full_height / 2 - scale * upward - 0.5 - whole.top
    return np.stack([column, row, forward])


def seen_before(
    surface: Surface, before: Surface, was: np.ndarray | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Find a frame's points in the previous frame.

    A point counts if all four pixels of its look-up show a surface of its depth, to 2 %, and of its
    normal, to 0.4 (Datta et al. 2022, 3.4; thresholds of Hu et al. 2025's code).

    Args:
        was: (n, 3), the points' previous positions, by default the current ones.

    Returns:
        accepted (n,) bool, and column and row in the frame before, (2, n).
    """
    points = surface.p if was is None else was
    width, height = before.width, before.height
    column, row, depth = projected(before.camera, width, height, points)
    near = LEAST_WEIGHT  # rounding must not drop a rim
    inside = (depth > 0) & (column >= -near) & (row >= -near)
    inside &= (column <= width - 1 + near) & (row <= height - 1 + near)
    accepted = inside.copy()
    c = np.clip(np.nan_to_num(np.floor(column)), 0, width - 2).astype(np.int64)
    r = np.clip(np.nan_to_num(np.floor(row)), 0, height - 2).astype(np.int64)
    depths = before.image(projected(before.camera, width, height, before.p)[2])
    normals = before.image(before.n_g)
    x, y = column - c, row - r
    for down in (0, 1):
        for along in (0, 1):
            weight = np.abs(1 - along - x) * np.abs(1 - down - y)
            other = depths[r + down, c + along]
            same = np.abs(other - depth) <= DEPTH_SHARE * np.abs(depth)
            difference = normals[r + down, c + along] - surface.n_g
            same &= np.linalg.norm(difference, axis=1) <= NORMAL_DISTANCE
            accepted &= same | (weight < LEAST_WEIGHT)
    return accepted, np.stack([column, row])


def looked_up(image: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Look up an image (H, W) at columns and rows (2, n): (n,) float32."""
    column, row = places
    return map_coordinates(image.astype(np.float32), [row, column], order=1, mode="nearest")

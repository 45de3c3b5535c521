"""Reprojection to the previous frame, for instability and temporal filters."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.ndimage import map_coordinates

from neural_shadows.rendering.lengths import lengths_of
from neural_shadows.rendering.surface import Surface
from neural_shadows.scenes.cameras import Window, camera_axes

DEPTH_SHARE, NORMAL_DISTANCE = 0.02, 0.4  # thresholds of another surface
LEAST_WEIGHT = 1e-3  # least weight of a pixel that must agree
LEAST_HISTORY = 0.01  # least weight of the pixels that show a point


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


@dataclass(frozen=True, eq=False)
class Reprojection:
    """Look-up of a frame's points in the frame before. Computed once, on first use.

    Args:
        surface, before: what the camera sees now, and saw then.
        was: (n, 3), where the n points of `surface` were then; without it, where they are.
    """

    surface: Surface
    before: Surface
    was: np.ndarray | None = None

    @property
    def seen(self) -> tuple[np.ndarray, np.ndarray]:
        """The points that were seen.

        A point counts if all four pixels of its look-up show a surface of its depth, to 2 %, and of its
        normal, to 0.4 (Datta et al. 2022, 3.4; thresholds of Hu et al. 2025's code).

        Returns: accepted (n,) bool, and column and row in the frame before, (2, n).
        """
        return self._found[:2]

    def history(self, images: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Images of the frame before, where it shows the points.

        Bilinear over those of the four pixels that show the point's surface, see `seen`, as
        temporal filters do it (Schied et al. 2017, 4.1): along an edge, where `seen` accepts
        nothing, a filter keeps the history of its own side.

        Args:
            images: (k, H, W) float32, of the frame before.

        Returns: found (n,) bool, and values of the points found, (k, m) float32.
        """
        found, shares, pixels = self._found[2:]
        corners = images.reshape(len(images), -1)[:, pixels]
        return found, np.einsum("kcm,cm->km", corners, shares).astype(np.float32)

    @cached_property
    def _found(self) -> tuple[np.ndarray, ...]:
        """`seen`; and for `history` the points found, and their pixels' shares and numbers, (4, m)."""
        before, points = self.before, self.surface.p if self.was is None else self.was
        column, row, depth = projected(before.camera, before.width, before.height, points)
        pixels, weights, same = _corners(self.surface, before, column, row, depth)
        inside = _inside(before, column, row, depth)
        accepted = inside & (same | (weights < LEAST_WEIGHT)).all(axis=0)
        weights = np.where(same, weights, 0)
        total = weights.sum(axis=0)
        found = inside & (total >= LEAST_HISTORY)
        shares = weights[:, found] / total[found]
        return accepted, np.stack([column, row]), found, shares, pixels[:, found].astype(np.int32)


def _inside(before: Surface, column: np.ndarray, row: np.ndarray, depth: np.ndarray) -> np.ndarray:
    """Which places are within the image and before the camera, (n,) bool."""
    near = LEAST_WEIGHT  # rounding must not drop a rim
    inside = (depth > 0) & (column >= -near) & (row >= -near)
    return inside & (column <= before.width - 1 + near) & (row <= before.height - 1 + near)


def _corners(
    surface: Surface, before: Surface, column: np.ndarray, row: np.ndarray, depth: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The four pixels about each place: numbers, bilinear weights, and which show its surface, (4, n)."""
    width, height = before.width, before.height
    c = np.clip(np.nan_to_num(np.floor(column)), 0, max(width - 2, 0)).astype(np.int64)
    r = np.clip(np.nan_to_num(np.floor(row)), 0, max(height - 2, 0)).astype(np.int64)
    depths = before.image(projected(before.camera, width, height, before.p)[2]).ravel()
    normals = before.image(before.n_g).reshape(-1, 3)
    x, y = column - c, row - r
    steps = [(down, along) for down in (0, 1) for along in (0, 1)]
    weights = np.stack([np.abs(1 - along - x) * np.abs(1 - down - y) for down, along in steps])
    rows = np.stack([np.minimum(r + down, height - 1) for down, _ in steps])
    pixels = rows * width + np.stack([np.minimum(c + along, width - 1) for _, along in steps])
    same = np.abs(depths[pixels] - depth) <= DEPTH_SHARE * np.abs(depth)
    same &= lengths_of(normals[pixels] - surface.n_g) <= NORMAL_DISTANCE
    return pixels, weights, same


def looked_up(image: np.ndarray, places: np.ndarray, order: int = 1) -> np.ndarray:
    """Look up an image (H, W) at columns and rows (2, n): (n,) float32.

    Args:
        order: of the spline, 1 linear, 3 cubic.
    """
    column, row = places
    return map_coordinates(image.astype(np.float32), [row, column], order=order, mode="nearest")

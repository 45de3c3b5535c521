"""A temporal filter's history."""

import numpy as np

from neural_shadows.rendering.reprojection import Reprojection


class History:
    """Images of the previous frame, looked up at the current points."""

    def __init__(self):
        self._images: np.ndarray | None = None

    def at(self, count: int, back: Reprojection | None) -> tuple[np.ndarray, np.ndarray]:
        """Find pixels seen in the previous frame, and its images there.

        Args:
            count: of the images. back: to that frame; None where there is none.

        Returns:
            pixels (m,) int64, row · width + column, and values (count, m) float32.
        """
        if self._images is None or back is None:
            return np.empty(0, np.int64), np.empty((count, 0), np.float32)
        found, values = back.history(self._images)
        return back.surface.pixel[found], values

    def keep(self, images: np.ndarray) -> None:
        """Store a frame's images (count, H, W) float32."""
        self._images = images

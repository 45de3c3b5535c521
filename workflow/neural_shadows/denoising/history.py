"""A temporal filter's history."""

import numpy as np

from neural_shadows.rendering.reprojection import history
from neural_shadows.rendering.surface import Surface


class History:
    """Images of the previous frame, looked up at the current points."""

    def __init__(self):
        self._images: np.ndarray | None = None
        self._surface: Surface | None = None

    def at(
        self, surface: Surface, count: int, was: np.ndarray | None = None
    ) -> tuple[np.ndarray, np.ndarray]:
        """Find pixels seen in the previous frame, and its images there.

        Args:
            surface: of the frame now. was: (n, 3), where its points were; see `seen_before`.
            count: of the images.

        Returns:
            pixels (m,) int64, row · width + column, and values (count, m) float32.
        """
        if self._images is None:
            return np.empty(0, np.int64), np.empty((count, 0), np.float32)
        found, values = history(surface, self._surface, self._images, was)
        return surface.pixel[found], values

    def keep(self, surface: Surface, images: np.ndarray) -> None:
        """Store a frame's images (count, H, W) float32."""
        self._images, self._surface = images, surface

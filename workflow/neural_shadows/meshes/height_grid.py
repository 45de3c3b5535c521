"""Open sheets above a grid."""

import numpy as np


def height_grid(x: np.ndarray, heights: np.ndarray, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (n m, 3) float64 and faces (2 (n − 1) (m − 1), 3) int64 of heights over a grid.

    y is up; faces are wound counter-clockwise from above.

    Args:
        x, heights, z: (n, m), x growing with the first index, z with the second.
    """
    vertices = np.stack([x, heights, z], axis=-1).reshape(-1, 3)
    corner = np.arange(heights.size).reshape(heights.shape)
    a, b, c, d = corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]
    return vertices, np.stack([a, d, b, b, d, c], axis=-1).reshape(-1, 3)

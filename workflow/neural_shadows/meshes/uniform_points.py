"""Random points on a mesh."""

import numpy as np


def uniform_points(
    vertices: np.ndarray, faces: np.ndarray, count: int, rng: np.random.Generator
) -> tuple[np.ndarray, np.ndarray]:
    """Draw points, evenly by area.

    Args:
        vertices: (V, 3), faces: (F, 3), of some area.

    Returns:
        Points (count, 3) float64, and the index of each one's face, (count,) int64.
    """
    a, b, c = (np.take(vertices, faces[:, k], axis=0) for k in range(3))
    sums = np.cumsum(np.linalg.norm(np.cross(b - a, c - a), axis=1), dtype=np.float64)
    face = np.searchsorted(sums, rng.random(count) * sums[-1], side="right")
    face = np.minimum(face, len(sums) - 1)  # a product may round up to the sum of all
    u, v = rng.random((2, count, 1))
    u, v = np.where(u + v > 1, 1 - u, u), np.where(u + v > 1, 1 - v, v)
    return a[face] + u * (b - a)[face] + v * (c - a)[face], face

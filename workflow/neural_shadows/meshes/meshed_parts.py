"""Closed meshes of signed-distance parts, by marching cubes."""

from collections.abc import Sequence

import numpy as np
from skimage.measure import marching_cubes
from trimesh.graph import connected_component_labels

from neural_shadows.meshes.signed_distances import Part, distance_grid

# Samples nearer to the surface than this (in cells) are moved outside: a vertex on a grid point would
# give triangles without area.
MIN_VALUE_CELLS = 0.01


def meshed(parts: Sequence[Part], cells: int) -> tuple[np.ndarray, np.ndarray]:
    """Watertight mesh of parts: one piece, lowest point on y = 0.

    Args:
        cells: along the longest side.

    Returns:
        Vertices (V, 3) float64 and faces (F, 3) int64. Wound outward, and deterministic to the byte.
    """
    grid, origin, cell = distance_grid(list(parts), cells)
    grid[np.abs(grid) < MIN_VALUE_CELLS * cell] = MIN_VALUE_CELLS * cell
    vertices, faces, _, _ = marching_cubes(grid, 0.0)
    # Drop fragments: bubbles between parts, and tips cut off by a coarse grid.
    labels = connected_component_labels(faces[:, [[0, 1], [1, 2]]].reshape(-1, 2), len(vertices))
    largest = labels == np.bincount(labels).argmax()
    faces = (np.cumsum(largest) - 1)[faces[largest[faces[:, 0]]]]
    vertices = origin + cell * vertices[largest].astype(np.float64)
    vertices[:, 1] -= vertices[:, 1].min()
    return vertices, faces.astype(np.int64)

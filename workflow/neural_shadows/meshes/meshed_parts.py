"""Parts of signed distances as one closed mesh, by marching cubes."""

from collections.abc import Sequence

import numpy as np
from skimage.measure import marching_cubes
from trimesh.graph import connected_component_labels

from neural_shadows.meshes.signed_distances import Part, distance_grid

# Samples nearer to the surface than this (in cells) count as just outside: no vertex falls on a
# grid point, where marching cubes would emit triangles without area.
MIN_VALUE_CELLS = 0.01


def meshed(parts: Sequence[Part], cells: int) -> tuple[np.ndarray, np.ndarray]:
    """Mesh of parts: watertight, one piece, wound outward, lowest point on y = 0.

    Args:
        cells: along the longest side.

    Returns:
        Vertices (V, 3) float64 and faces (F, 3) int64. The same bytes each time.
    """
    grid, origin, cell = distance_grid(list(parts), cells)
    grid[np.abs(grid) < MIN_VALUE_CELLS * cell] = MIN_VALUE_CELLS * cell
    vertices, faces, _, _ = marching_cubes(grid, 0.0)
    # Crumbs: bubbles where parts meet, and tips that a coarse grid cuts off.
    labels = connected_component_labels(faces[:, [[0, 1], [1, 2]]].reshape(-1, 2), len(vertices))
    keep = labels == np.bincount(labels).argmax()
    faces = (np.cumsum(keep) - 1)[faces[keep[faces[:, 0]]]]
    vertices = origin + cell * vertices[keep].astype(np.float64)
    vertices[:, 1] -= vertices[:, 1].min()
    return vertices, faces.astype(np.int64)

"""A mesh with detail that its field cannot hold: waves as high as a cell and down to two cells long."""

from collections.abc import Iterator

import numpy as np
import trimesh

# Of each wave, in cells: its length and its height. Their sum is a cell high (root mean square), and
# the surface as steep as 1.6: the field's error on it is no longer that of a smooth mesh.
WAVES = ((8, 1.0), (4, 0.5), (2, 0.25))
_HIGHEST = 1.5 * sum(height for _, height in WAVES)  # of `_waves` at most


def detailed_meshes(
    vertices: np.ndarray, faces: np.ndarray, normals: np.ndarray, cell: float, most: int
) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """One detailed surface in ever more triangles, from four times as many on.

    Args:
        vertices, normals: (V, 3) of a mesh in the unit sphere, which the surfaces stay in.
        faces: (F, 3).
        cell: the side of a field's cell.
        most: triangles.

    Yields:
        Vertices (V', 3) float32 and faces (F', 3) int32.
    """
    attributes = {"normals": normals}
    while 4 * len(faces) <= most:
        vertices, faces, attributes = trimesh.remesh.subdivide(
            vertices, faces, vertex_attributes=attributes
        )
        yield _displaced(vertices, attributes["normals"], cell), faces.astype(np.int32)


def _displaced(vertices: np.ndarray, normals: np.ndarray, cell: float) -> np.ndarray:
    height = cell * _waves(vertices / cell)
    normals = normals / np.linalg.norm(normals, axis=1, keepdims=True)
    moved = vertices + height[:, None] * normals
    return (moved / (1 + _HIGHEST * cell)).astype(np.float32)


def _waves(p: np.ndarray) -> np.ndarray:
    """Heights (n,) at places (n, 3), both in cells: sums of gyroids."""
    total = np.zeros(len(p))
    for length, height in WAVES:
        phase = 2 * np.pi / length * p
        total += height * (np.sin(phase) * np.cos(np.roll(phase, 1, axis=1))).sum(1)
    return total

"""Compact encoding of meshes for a browser.

Vertices are differences on a grid. Triangles are ordered from neighbour to neighbour, vertices are
numbered by first use, and a corner is coded by its distance to the next new number: mostly 0 to 2.
The Stanford dragon (201,031 triangles) takes 3.4 bytes per triangle, deflated.
"""

from typing import NamedTuple

import numpy as np
import trimesh
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components, depth_first_order

from neural_shadows.viewer.packed import zigzag

# Of a coordinate in [−1, 1]: steps of 1.2e-4 radii, an eighth of the shading points' offset.
BITS = 14


class MeshArrays(NamedTuple):
    """Arrays read by the viewer's mesh.js."""

    steps: np.ndarray  # (3, V) uint16, zigzag: from each vertex's grid position to the next's
    codes: np.ndarray  # (3 F) uint32, distance of a corner to the next new vertex's number


def mesh_arrays(vertices: np.ndarray, faces: np.ndarray) -> MeshArrays:
    """Encode vertices (V, 3) in [−1, 1] and triangles (F, 3).

    Unused vertices are dropped."""
    corners = faces[_by_neighbours(faces)].reshape(-1)
    used, first = np.unique(corners, return_index=True)
    order = used[np.argsort(first)]
    number = np.empty(len(vertices), np.int64)
    number[order] = np.arange(len(order))
    corners = _newest_last(number[corners].reshape(-1, 3)).reshape(-1)
    newest = np.maximum.accumulate(np.concatenate([[-1], corners[:-1]]))
    positions = np.round((vertices[order].astype(np.float64) + 1) / 2 * (2**BITS - 1)).astype(
        np.int64
    )
    steps = np.diff(positions, axis=0, prepend=0).T
    return MeshArrays(zigzag(steps), (newest + 1 - corners).astype(np.uint32))


def _newest_last(faces: np.ndarray) -> np.ndarray:
    """Rotate triangles (F, 3): largest vertex number last.

    The Stanford dragon's corners take 371 KiB instead of 428.
    """
    order = (faces.argmax(1)[:, None] + np.array([1, 2, 3])) % 3
    return np.take_along_axis(faces, order, 1)


def _by_neighbours(faces: np.ndarray) -> np.ndarray:
    """Order (F,) of triangles, mostly from neighbour to neighbour."""
    count = len(faces)
    pairs = trimesh.graph.face_adjacency(faces)
    joined = coo_matrix((np.ones(len(pairs)), pairs.T), shape=(count, count))
    _, piece = connected_components(joined, directed=False)
    # A root adjacent to one triangle of each piece joins all pieces into one walk.
    _, starts = np.unique(piece, return_index=True)
    pairs = np.concatenate([pairs, np.stack([np.full(len(starts), count), starts], axis=1)])
    joined = coo_matrix((np.ones(len(pairs)), pairs.T), shape=(count + 1, count + 1)).tocsr()
    walk = depth_first_order(joined, count, directed=False, return_predecessors=False)
    return walk[1:]

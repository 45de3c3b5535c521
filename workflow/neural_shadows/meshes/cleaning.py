"""Triangle meshes: reading what users bring, cleaning it, and the move to normalised space."""

from typing import Any

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree
from trimesh.grouping import unique_rows

from neural_shadows.errors import InputError

# Vertices closer than this share of the bounding box's diagonal are one vertex, and
# triangles lower than it are none. It is below the rounding of float32 (6e-8), in which
# rays are traced, and above that of float64 at an offset of 1e6 (1e-10).
MERGE_DISTANCE = 1e-8


def clean_mesh(
    vertices: np.ndarray, faces: np.ndarray, name: str
) -> tuple[np.ndarray, np.ndarray, dict[str, Any]]:
    """Make every vertex and face count once; open meshes stay as they are.

    Vertices within `MERGE_DISTANCE` of the bounding box's diagonal are merged (into the
    first of them), then faces of no height (relative to the same) and repeated faces (the
    same three vertices, whatever the winding) are dropped, then vertices of no face. Of a
    flap made of two opposite faces one stays, so its rim then counts as open (the Stanford
    dragon loses 1,489 faces, nearly all of them to such flaps). None of it depends on the
    unit or on an offset.

    Args:
        vertices: (V, 3) in any unit.
        faces: (F, 3) indices into them.
        name: what error messages call the mesh.

    Returns:
        Vertices (V', 3) float64 and faces (F', 3) int64 in their first order, and a report:
        the counts before and after, what was merged and dropped, and how closed the surface
        is (`watertight`: two faces at every edge; `open_edges`: edges of a single face;
        `non_manifold_edges`: edges of more than two; `bodies`: connected components).

    Raises:
        InputError: a NaN or infinite coordinate, or no face with an area.
    """
    source_vertices, source_faces = len(vertices), len(faces)
    vertices = np.asarray(vertices, dtype=np.float64)
    faces = np.asarray(faces, dtype=np.int64)
    bad = np.flatnonzero(~np.isfinite(vertices).all(axis=1))
    if len(bad):
        x, y, z = vertices[bad[0]]
        raise InputError(
            f"mesh {name}: vertex {bad[0]} (counted from 0) is ({x}, {y}, {z}), and "
            f"{len(bad)} in all have a coordinate that is not a finite number; mend the mesh"
        )

    vertices, faces = _drop_unreferenced(vertices, faces)
    unreferenced = source_vertices - len(vertices)
    # About the origin and with a diagonal of 1, so that tolerances are relative and an
    # offset costs no digits of a product.
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    diagonal = np.linalg.norm(high - low)
    if not 0 < diagonal < np.inf:
        raise InputError(
            f"mesh {name}: its bounding box has the diagonal {diagonal:g}; give a mesh with a size"
        )
    points = (vertices - (low + (high - low) / 2)) / diagonal

    first, group = _merge(points)
    vertices, points, faces = vertices[first], points[first], group[faces]
    merged = len(group) - len(first)

    kept = faces[_heights(points[faces]) > MERGE_DISTANCE]
    degenerate = len(faces) - len(kept)
    if len(kept) == 0:
        raise InputError(
            f"mesh {name}: all {source_faces} faces have zero area; give a mesh with a surface"
        )
    unique, _ = unique_rows(np.sort(kept, axis=1), keep_order=True)
    faces = kept[unique]

    joined = len(vertices)
    vertices, faces = _drop_unreferenced(vertices, faces)
    report = {
        "source_vertices": source_vertices,
        "source_faces": source_faces,
        "vertices": len(vertices),
        "faces": len(faces),
        "merged_vertices": merged,
        "unreferenced_vertices": unreferenced + joined - len(vertices),
        "degenerate_faces": degenerate,
        "duplicate_faces": len(kept) - len(faces),
        **_topology(faces),
    }
    return vertices, faces, report


def _drop_unreferenced(vertices: np.ndarray, faces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Vertices that some face names, in their order, and the faces with the new indices."""
    used = np.zeros(len(vertices), dtype=bool)
    used[faces] = True
    return vertices[used], (np.cumsum(used) - 1)[faces]


def _merge(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Group points that are within `MERGE_DISTANCE` of each other, chains included.

    Returns:
        Index of each group's first point (G,) and the group of each point (n,).
    """
    # First by cells that are small enough for all in one to be that close: a tree alone
    # would list n^2 / 2 pairs where n points coincide.
    cells = np.round(points / (MERGE_DISTANCE / np.sqrt(3))).astype(np.int64)
    first, cell = unique_rows(cells, keep_order=True)
    pairs = cKDTree(points[first]).query_pairs(MERGE_DISTANCE, output_type="ndarray")
    group = _components(pairs, len(first))[cell]
    _, first = np.unique(group, return_index=True)
    return first, group


def _components(pairs: np.ndarray, count: int) -> np.ndarray:
    """Label (count,) of the connected component of each node, given (n, 2) linked pairs."""
    links = coo_array((np.ones(len(pairs), dtype=bool), pairs.T), shape=(count, count))
    return connected_components(links, directed=False)[1]


def _heights(corners: np.ndarray) -> np.ndarray:
    """Height (F,) over the longest side of triangles (F, 3, 3); 0 where all corners coincide."""
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    doubled_areas = np.linalg.norm(normals, axis=1)
    return np.divide(doubled_areas, longest, out=np.zeros_like(longest), where=longest > 0)


def _topology(faces: np.ndarray) -> dict[str, Any]:
    """How closed a surface is, given its faces (F, 3) without unreferenced vertices."""
    sides = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    first, edge = unique_rows(sides)
    uses = np.bincount(edge)
    return {
        "watertight": bool((uses == 2).all()),
        "open_edges": int((uses == 1).sum()),
        "non_manifold_edges": int((uses > 2).sum()),
        "bodies": int(_components(sides[first], int(faces.max()) + 1).max()) + 1,
    }

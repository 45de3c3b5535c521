"""Cleaning of meshes, and closedness of surfaces."""

from typing import Any

import numpy as np
import trimesh

from neural_shadows.errors import InputError

# Relative to the bounding box's diagonal: vertices equal to so many digits are merged, and triangles
# lower than a unit of the last are dropped. This is below the rounding of float32 (6e-8), used for
# tracing, and above that of float64 at an offset of 1e6 (1e-10).
DIGITS = 8


def clean_mesh(
    vertices: np.ndarray, faces: np.ndarray, name: str
) -> tuple[np.ndarray, np.ndarray, dict[str, Any]]:
    """Remove duplicate and degenerate elements; open meshes stay open.

    Vertices that agree to 1e-8 of the bounding box's diagonal are merged (into the first of
    them), then faces of no height (relative to the same) and repeated faces (the same three
    vertices, whatever the winding) are dropped, then vertices of no face. Of two
    opposite faces (a flap) one stays, so that its rim then counts as open (the Stanford dragon loses
    1,489 faces, nearly all to such flaps). The result depends on neither unit nor offset.

    Args:
        vertices: (V, 3) in any unit.
        faces: (F, 3) indices into them.
        name: of the mesh in messages.

    Returns:
        Vertices (V', 3) float64 and faces (F', 3) int64 in their first order, and a report:
        counts before and after, and of merged and dropped elements.

    Raises:
        InputError: a coordinate is not finite, or no face has an area.
    """
    vertices = np.asarray(vertices, dtype=np.float64)
    invalid = np.flatnonzero(~np.isfinite(vertices).all(axis=1))
    if len(invalid):
        x, y, z = vertices[invalid[0]]
        raise InputError(
            f"mesh {name}: vertex {invalid[0]} (counted from 0) is ({x}, {y}, {z}); "
            f"{len(invalid)} in all have a coordinate that is not finite. Repair the mesh"
        )
    used = np.zeros(len(vertices), dtype=bool)
    used[faces] = True
    low, high = vertices[used].min(axis=0), vertices[used].max(axis=0)
    diagonal = np.linalg.norm(high - low)
    if not 0 < diagonal < np.inf:
        raise InputError(
            f"mesh {name}: its bounding box has the diagonal {diagonal:g}. Give a mesh of finite, positive size"
        )
    # About the origin with a diagonal of 1: tolerances are relative, and an offset costs no digits
    # of products. Unused vertices may lie anywhere.
    points = np.zeros_like(vertices)
    points[used] = (vertices[used] - (low + (high - low) / 2)) / diagonal
    mesh = trimesh.Trimesh(
        points, faces, vertex_attributes={"source": vertices}, process=False, validate=False
    )
    mesh.merge_vertices(digits_vertex=DIGITS)
    merged = int(used.sum()) - len(mesh.vertices)
    high_enough = mesh.nondegenerate_faces(height=10**-DIGITS)
    if not high_enough.any():
        raise InputError(
            f"mesh {name}: all {len(faces)} faces have zero area. Give a mesh with a surface"
        )
    mesh.update_faces(high_enough)
    mesh.update_faces(mesh.unique_faces())
    mesh.remove_unreferenced_vertices()
    report = {
        "source_vertices": len(vertices),
        "source_faces": len(faces),
        "vertices": len(mesh.vertices),
        "faces": len(mesh.faces),
        "merged_vertices": merged,
        "unreferenced_vertices": len(vertices) - merged - len(mesh.vertices),
        "degenerate_faces": int((~high_enough).sum()),
        "duplicate_faces": int(high_enough.sum()) - len(mesh.faces),
    }
    return mesh.vertex_attributes["source"], np.asarray(mesh.faces, np.int64), report


def closedness(faces: np.ndarray) -> dict[str, Any]:
    """Closedness of the surface of a clean mesh.

    Args:
        faces: (F, 3) vertex indices, all of which occur.

    Returns:
        `watertight`: two faces at every edge; `open_edges`: edges of a single face;
        `non_manifold_edges`: edges of more than two; `bodies`: connected components.
    """
    mesh = trimesh.Trimesh(np.zeros((faces.max() + 1, 3)), faces, process=False)
    uses = np.bincount(mesh.edges_unique_inverse)
    return {
        "watertight": bool((uses == 2).all()),
        "open_edges": int((uses == 1).sum()),
        "non_manifold_edges": int((uses > 2).sum()),
        "bodies": mesh.body_count,
    }

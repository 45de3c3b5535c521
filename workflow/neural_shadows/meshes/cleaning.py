"""Cleaning of meshes, and closedness of surfaces."""

from typing import Any

import numpy as np

from neural_shadows.errors import InputError
from neural_shadows.meshes.equal_rows import first_equal
from neural_shadows.meshes.sides import count_bodies, edges_by_uses

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
    kept, faces = _merged(points, used, faces)
    high_enough = _high_faces(points[kept], faces)
    if not high_enough.any():
        raise InputError(
            f"mesh {name}: all {len(faces)} faces have zero area. Give a mesh with a surface"
        )
    faces = faces[high_enough]
    once = first_equal(np.sort(faces, axis=1)) == np.arange(len(faces))
    faces = faces[once]
    occur = np.zeros(len(kept), dtype=bool)
    occur[faces] = True
    report = {
        "source_vertices": len(vertices),
        "source_faces": len(high_enough),
        "vertices": int(occur.sum()),
        "faces": len(faces),
        "merged_vertices": int(used.sum()) - len(kept),
        "unreferenced_vertices": len(vertices) - int(used.sum()) + int((~occur).sum()),
        "degenerate_faces": int((~high_enough).sum()),
        "duplicate_faces": int((~once).sum()),
    }
    return vertices[kept[occur]], (np.cumsum(occur) - 1)[faces], report


def _merged(
    points: np.ndarray, used: np.ndarray, faces: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Merge used vertices that are equal to `DIGITS`.

    Returns the indices of those kept, and faces of their numbers."""
    kept = np.flatnonzero(used)
    first = first_equal(np.round(points[kept] * 10**DIGITS))
    new = first == np.arange(len(kept))
    numbers = np.zeros(len(points), np.int64)
    numbers[kept] = (np.cumsum(new) - 1)[first]
    return kept[new], numbers[faces]


def _high_faces(points: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Mask (F,) bool of faces higher than a unit of the last of `DIGITS`."""
    a, b, c = (np.take(points, faces[:, k], axis=0) for k in range(3))
    b -= a
    c -= a
    doubled = np.cross(b, c)
    least = 10.0**-DIGITS
    high = np.ones(len(faces), bool)
    area = np.sqrt((doubled**2).sum(axis=1))
    for side in (b, c):
        length = np.sqrt((side**2).sum(axis=1))
        high &= (length > least) & (area > least * length)
    return high


def closedness(faces: np.ndarray) -> dict[str, Any]:
    """Closedness of the surface of a clean mesh.

    Args:
        faces: (F, 3) vertex indices, all of which occur.

    Returns:
        `watertight`: two faces at every edge; `open_edges`: edges of a single face;
        `non_manifold_edges`: edges of more than two; `bodies`: connected components.
    """
    count = int(faces.max()) + 1
    once, twice, more = edges_by_uses(faces, count).tolist()
    return {
        "watertight": once == more == 0,
        "open_edges": once,
        "non_manifold_edges": more,
        "bodies": count_bodies(faces, count),
    }

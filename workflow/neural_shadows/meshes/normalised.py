"""Clean meshes in normalised space [3.3.1]."""

from typing import Any, NamedTuple

import numpy as np

from neural_shadows.meshes.bounding_sphere import minimal_bounding_sphere
from neural_shadows.meshes.cleaning import clean_mesh, closedness
from neural_shadows.meshes.open_sides import is_sheet

_DROPPED = ("merged_vertices", "unreferenced_vertices", "degenerate_faces", "duplicate_faces")


class NormalisedMesh(NamedTuple):
    """A clean mesh at x' = (x − c) / r, in its minimal bounding sphere."""

    vertices: np.ndarray  # (V, 3) float32, in the unit sphere
    faces: np.ndarray  # (F, 3) int64
    centre: np.ndarray  # (3,) float64, c
    radius: float  # r
    sheet: bool  # open, without an inside; see `is_sheet`
    report: dict[str, Any]  # of `clean_mesh` and `closedness`


def normalised(vertices: np.ndarray, faces: np.ndarray, name: str) -> NormalisedMesh:
    """Clean a mesh and map it into the unit sphere.

    Args:
        vertices, faces, name: see `clean_mesh`.

    Raises:
        InputError: as `clean_mesh`.
    """
    vertices, faces, report = clean_mesh(vertices, faces, name)
    centre, radius = minimal_bounding_sphere(vertices)
    inside = ((vertices - centre) / radius).astype(np.float32)
    # Rounding to float32 (spacing 6e-8 at 1) may merge distinct vertices: clean once more.
    inside, faces, again = clean_mesh(inside, faces, name)
    closed = closedness(faces)
    report = {
        **again,
        **{key: report[key] for key in ("source_vertices", "source_faces")},
        **{key: report[key] + again[key] for key in _DROPPED},
        **closed,
    }
    sheet = not closed["watertight"] and is_sheet(inside, faces)
    return NormalisedMesh(inside.astype(np.float32), faces, centre, radius, sheet, report)

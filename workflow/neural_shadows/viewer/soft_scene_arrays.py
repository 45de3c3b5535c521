"""A scene in metres as compact arrays for a browser."""

from typing import Any

import numpy as np

from neural_shadows.evaluation.method_parts.object_field import fitted_field
from neural_shadows.frames.soft_scene import SoftScene
from neural_shadows.representations.distance_bricks.field_marching import SAMPLES_PER_CELL
from neural_shadows.representations.meshes.decimation import decimated
from neural_shadows.scenes.scene import Scene
from neural_shadows.viewer.field_arrays import field_arrays
from neural_shadows.viewer.mesh_arrays import BITS, mesh_arrays
from neural_shadows.viewer.packed import packed

# Of the scene's size, a field's cells. In the room cones then err 7 % more than with the pipeline's half as
# wide; with twice as wide ones 2 times as much.
FIELD_CELL = 0.001
_LEAST = 300  # triangles of an object that stay as they are
_MARGIN = 0.02  # of the scene's size, between a light and the bounds


def shown_scene(scene: SoftScene, triangles: int) -> tuple[dict[str, Any], int, int]:
    """Arrays of a scene's objects, see scene.js.

    Returns:
        `objects`, each with its mesh in its own box, of `middle` (3) and `half` a side in metres; the
        `mover`'s index; `size` of the scene; `bounds` of lights, two corners. Then the number of
        triangles, and that of the scene.

    Args:
        triangles: at most, of all objects.
    """
    opened = scene.at_rest
    counts = np.array([len(mesh.faces) for mesh in opened.objects])
    objects = [
        _object(mesh.vertices, mesh.faces, kept)
        for mesh, kept in zip(opened.objects, _kept(counts, triangles))
    ]
    vertices, margin = opened.joined.vertices, _MARGIN * opened.size
    data = {
        "objects": [data for data, _ in objects],
        "mover": scene.arrangement.mover_index,
        "size": opened.size,
        "bounds": [(vertices.min(0) + margin).tolist(), (vertices.max(0) - margin).tolist()],
    }
    return data, sum(count for _, count in objects), int(counts.sum())


def shown_fields(scene: Scene) -> dict[str, Any]:
    """Fields of a scene's closed objects for cones, see scene.js.

    Returns:
        `cell`, metres; `samples_per_cell` of a ray; `objects`: of each its `field_arrays`, None of an
        open one.
    """
    cell = FIELD_CELL * scene.size
    fields = (fitted_field(mesh, cell) for mesh in scene.objects)
    return {
        "cell": cell,
        "samples_per_cell": SAMPLES_PER_CELL,
        "objects": [None if field is None else field_arrays(field) for field in fields],
    }


def _kept(counts: np.ndarray, most: int) -> np.ndarray:
    """Triangles kept of each object: those of large ones in proportion to their roots."""
    if counts.sum() <= most:
        return counts
    low, high = 0.0, float(np.sqrt(counts.max()))
    for _ in range(60):
        middle = (low + high) / 2
        kept = np.minimum(counts, np.maximum(_LEAST, middle * np.sqrt(counts)))
        low, high = (middle, high) if kept.sum() <= most else (low, middle)
    return np.minimum(counts, np.maximum(_LEAST, low * np.sqrt(counts))).astype(int)


def _object(vertices: np.ndarray, faces: np.ndarray, kept: int) -> tuple[dict[str, Any], int]:
    low, high = vertices.min(0).astype(np.float64), vertices.max(0).astype(np.float64)
    middle, half = (low + high) / 2, float((high - low).max()) / 2
    vertices, faces = decimated((vertices - middle) / half, faces, int(kept))
    arrays = mesh_arrays(np.asarray(vertices), np.asarray(faces))
    mesh = {"bits": BITS, **{key: packed(array) for key, array in arrays._asdict().items()}}
    return {"mesh": mesh, "middle": middle.tolist(), "half": half}, len(faces)

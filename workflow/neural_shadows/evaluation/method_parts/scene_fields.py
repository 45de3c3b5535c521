"""Distance fields of a scene's objects, cached, with rays through."""

from collections.abc import Iterable
from functools import lru_cache
from pathlib import Path

import numpy as np

from neural_shadows.evaluation.method_parts.object_field import (
    StoredFields,
    field_key,
    fitted_field,
)
from neural_shadows.frames.ray_tracing import ray_traced
from neural_shadows.frames.soft_frame import SoftFrame
from neural_shadows.meshes.prepared_mesh import PreparedMesh, joined_meshes
from neural_shadows.representations.shadow_field.shadow_field import ShadowField
from neural_shadows.scenes.scene import Scene
from neural_shadows.scenes.tracing import Tracer

CELL = 0.0005  # of the scene's size: preferred width of a field's cells
_MOST_CACHED = 64  # objects of about 5 MiB each
_cache: dict[str, ShadowField | None] = {}
_stored: list[StoredFields] = []


class SceneFields:
    """Fields of a scene's closed objects; a tracer of the others."""

    def __init__(self, scene: Scene):
        fields = [_field_of(mesh, CELL * scene.size) for mesh in scene.objects]
        self.fields = [field for field in fields if field is not None]
        rest = [mesh for mesh, field in zip(scene.objects, fields) if field is None]
        joined = joined_meshes(rest) if rest else None
        self.tracer = Tracer(joined.vertices, joined.faces) if rest else None

    def blocked(self, points: np.ndarray, to_light: np.ndarray) -> np.ndarray:
        """Occlusion of vectors (n, 3) from their points, (n,) bool."""
        blocked = np.zeros(len(points), bool)
        if self.tracer is not None:
            blocked |= self.tracer.blocked(points, to_light)
        for field in self.fields:
            field.block(points, to_light, blocked)
        return blocked


def _field_of(mesh: PreparedMesh, cell: float) -> ShadowField | None:
    """The field of an object in place; None of an open one.

    Cached until other scenes need the memory: in a sequence with one moving object, all others are
    fitted once.
    """
    key = field_key(mesh, cell)
    if key not in _cache:
        if len(_cache) >= _MOST_CACHED:
            _cache.clear()
        stored = (file.get(key) for file in _stored)
        _cache[key] = next(filter(None, stored), None) or fitted_field(mesh, cell)
    return _cache[key]


def take_stored(paths: Iterable[Path]) -> None:
    """Load fields of files of `write_fields`; fit any others.

    Raises:
        InputError: a file is missing or damaged.
    """
    _stored[:] = map(StoredFields, paths)


def fields_in(scene: Scene) -> dict[str, ShadowField]:
    """The fields of a scene's closed objects by `field_key`."""
    cell = CELL * scene.size
    fields = {field_key(mesh, cell): _field_of(mesh, cell) for mesh in scene.objects}
    return {key: field for key, field in fields.items() if field is not None}


def field_traced(frame: SoftFrame, radius: float, *, samples: int, cells: float) -> np.ndarray:
    """Share of a pixel's rays unblocked by fields, (n,) float32.

    Args:
        radius, samples: see `ray_traced`. cells: offset of the rays' starts from the surface, in
            `CELL`s, as a field's surface is not quite at the triangles.
    """
    off = np.float32(cells * CELL * frame.scene.size)
    starts = frame.surface.p + off * frame.surface.n_g
    fields = fields_of(frame.scene)
    return ray_traced(frame, radius, samples=samples, starts=starts, blocked=fields.blocked)


@lru_cache(maxsize=2)
def fields_of(scene: Scene) -> SceneFields:
    """The fields of a scene, shared by all of its frames."""
    return SceneFields(scene)

"""Rays through an occupancy field of each object instead of its triangles.

A field is a sparse grid of signed distances, fitted to the object's convex edges and not trained,
round each closed object of a scene; what is open has no inside and is traced as it is.
"""

from collections.abc import Iterable
from functools import lru_cache, partial
from pathlib import Path

import numpy as np

from neural_shadows.evaluation.soft_methods.object_field import (
    ObjectField,
    StoredFields,
    field_key,
    fitted_field,
)
from neural_shadows.evaluation.soft_methods.ray_traced import ray_traced
from neural_shadows.evaluation.soft_methods.soft_method import SoftMethod
from neural_shadows.frames.soft_frame import SoftFrame
from neural_shadows.meshes.prepared_mesh import PreparedMesh, joined_meshes
from neural_shadows.scenes.scene import Scene
from neural_shadows.scenes.tracing import Tracer

CELL = 0.0005  # of the scene's size: how wide a field's cells are wanted
_MOST_KEPT = 64  # objects, of some 5 MiB each
_kept: dict[str, ObjectField | None] = {}
_stored: list[StoredFields] = []


class SceneFields:
    """The fields of a scene's closed objects, and a tracer of the others."""

    def __init__(self, scene: Scene):
        found = [_field_of(mesh, CELL * scene.size) for mesh in scene.objects]
        self.fields = [field for field in found if field is not None]
        rest = [mesh for mesh, field in zip(scene.objects, found) if field is None]
        joined = joined_meshes(rest) if rest else None
        self.tracer = Tracer(joined.vertices, joined.faces) if rest else None

    def blocked(self, points: np.ndarray, ways: np.ndarray) -> np.ndarray:
        """Whether each way (n, 3) from its point is blocked, (n,) bool."""
        found = np.zeros(len(points), bool)
        if self.tracer is not None:
            found |= self.tracer.blocked(points, ways)
        for field in self.fields:
            field.block(points, ways, found)
        return found


def _field_of(mesh: PreparedMesh, cell: float) -> ObjectField | None:
    """The field of an object where it stands, kept until other scenes need the room; None of an open
    one.

    Of a sequence in which one object moves, all others are made once.
    """
    key = field_key(mesh, cell)
    if key not in _kept:
        if len(_kept) >= _MOST_KEPT:
            _kept.clear()
        stored = (one.get(key) for one in _stored)
        _kept[key] = next(filter(None, stored), None) or fitted_field(mesh, cell)
    return _kept[key]


def take_stored(paths: Iterable[Path]) -> None:
    """From now on take fields from files of `write_fields`; those that no file has are fitted.

    Raises:
        InputError: a file is missing or damaged.
    """
    _stored[:] = map(StoredFields, paths)


def fields_in(scene: Scene) -> dict[str, ObjectField]:
    """The fields of a scene's closed objects by `field_key`."""
    cell = CELL * scene.size
    found = {field_key(mesh, cell): _field_of(mesh, cell) for mesh in scene.objects}
    return {key: field for key, field in found.items() if field is not None}


def field_traced(frame: SoftFrame, radius: float, *, samples: int, cells: float) -> np.ndarray:
    """The share of a pixel's rays that no object's field blocks, (n,) float32, on one thread.

    Args:
        radius, samples: see `ray_traced`. cells: by how many times `CELL` rays start off the
            surface, which a field has not quite where the triangles have it.
    """
    off = np.float32(cells * CELL * frame.scene.size)
    starts = frame.surface.p + off * frame.surface.n_g
    fields = fields_of(frame.scene)
    return ray_traced(frame, radius, samples=samples, starts=starts, blocked=fields.blocked)


def field_bytes(frame: SoftFrame) -> int:
    """In memory of all fields of a frame's scene; what is traced as it is counts nothing."""
    return sum(field.bytes for field in fields_of(frame.scene).fields)


@lru_cache(maxsize=2)
def fields_of(scene: Scene) -> SceneFields:
    """The fields of a scene, which all of its frames share."""
    return SceneFields(scene)


def _by_fields(count: int) -> SoftMethod:
    answer, tried = partial(field_traced, samples=count), {"cells": (0.25, 0.5, 1.0, 2.0, 4.0)}
    return SoftMethod(answer, tried, held=field_bytes, texel_floats=0, by_rays=True)


METHODS = {f"field_{count}": _by_fields(count) for count in (1, 4, 16)}

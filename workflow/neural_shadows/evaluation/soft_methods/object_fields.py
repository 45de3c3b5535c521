"""Rays through an occupancy field of each object instead of its triangles.

A field is a sparse grid of signed distances, fitted to the object's convex edges and not trained,
round each closed object of a scene; what is open has no inside and is traced as it is.
"""

from functools import cached_property, lru_cache, partial
from hashlib import sha256

import numpy as np
import trimesh

from neural_shadows.evaluation.soft_methods.ray_traced import ray_traced
from neural_shadows.evaluation.soft_methods.soft_method import SoftMethod
from neural_shadows.frames.soft_frame import SoftFrame
from neural_shadows.meshes.prepared_mesh import PreparedMesh, joined_meshes, with_normals
from neural_shadows.networks.object_space.brick_distances import signed_distances
from neural_shadows.networks.object_space.brick_layout import lay_out
from neural_shadows.networks.object_space.distances_around import distances_around
from neural_shadows.networks.object_space.field_cones import ConeField
from neural_shadows.networks.object_space.field_marching import BRICK, blocked_ways
from neural_shadows.networks.object_space.occupancy import surface_cells
from neural_shadows.networks.object_space.occupancy_field_network import REACH, SAMPLES_PER_CELL
from neural_shadows.networks.object_space.surface_fit import fitted_distances
from neural_shadows.scenes.scene import Scene
from neural_shadows.scenes.tracing import Tracer

CELL = 0.0005  # of the scene's size: how wide a field's cells are wanted …
MOST = 256  # … but there are no more along an axis
_MOST_KEPT = 64  # objects, of some 5 MiB each
_kept: dict[tuple[bytes, float], "ObjectField | None"] = {}
_MARGIN = 1.02  # of an object's sphere, so that its surface is inside the grid


class ObjectField:
    """The field of one closed object, int8 values in bricks."""

    def __init__(self, mesh: PreparedMesh, cell: float):
        self.centre = (mesh.vertices.min(0) + mesh.vertices.max(0)).astype(np.float32) / 2
        away = np.linalg.norm(mesh.vertices - self.centre, axis=1).max()
        self.radius = np.float32(_MARGIN * away)
        wanted = int(np.ceil(2 * self.radius / cell / BRICK)) * BRICK
        self.resolution = int(np.clip(wanted, 8 * BRICK, MOST))
        merged = _merged(mesh)
        unit = with_normals((merged.vertices - self.centre) / self.radius, merged.faces)
        surface = surface_cells(unit.vertices, unit.faces, self.resolution // BRICK)
        layout = lay_out(surface, solid=True)
        distances = signed_distances(unit, layout, REACH)  # in cells, positive inside
        # As they are, they cut off convex edges. Eight cones of a sun of 1° past the Stanford dragon
        # then had 2.3 times the squared error, that of 5.3 rays instead of 9.2.
        distances = fitted_distances(unit, layout, distances).clip(-REACH, REACH)
        values = np.round(127 / REACH * distances).astype(np.int8)
        self.grid, self.bricks = layout.grid, values[layout.table]

    def block(self, points: np.ndarray, ways: np.ndarray, blocked: np.ndarray) -> None:
        """Mark the ways that it blocks, see `blocked_ways`."""
        steps = SAMPLES_PER_CELL * self.resolution
        told = self.grid, self.bricks, steps, np.float32(0)
        blocked_ways(points, ways, self.centre, self.radius, *told, blocked)

    @cached_property
    def cone_field(self) -> ConeField:
        """What cones walk through: its values, and distances where they end."""
        unit = np.float32(REACH / 127 * 2 / self.resolution)
        around = distances_around(self.grid, self.bricks).ravel()
        return ConeField(self.grid, self.bricks, unit, around)

    @property
    def bytes(self) -> int:
        """In memory while it answers rays."""
        return self.grid.nbytes + self.bricks.nbytes


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
    key = sha256(mesh.vertices.tobytes() + mesh.faces.tobytes()).digest(), cell
    if key not in _kept:
        if len(_kept) >= _MOST_KEPT:
            _kept.clear()
        _kept[key] = ObjectField(mesh, cell) if _is_closed(mesh) else None
    return _kept[key]


def _merged(mesh: PreparedMesh) -> trimesh.Trimesh:
    """With each vertex once: generated objects have one for each face, and edges are of vertices."""
    return trimesh.Trimesh(mesh.vertices, mesh.faces, process=True)


def _is_closed(mesh: PreparedMesh) -> bool:
    """Whether each edge has an even number of faces: 4 where two parts of an object touch."""
    return bool(np.all(np.bincount(_merged(mesh).edges_unique_inverse) % 2 == 0))


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
    answer, tried = partial(field_traced, samples=count), {"cells": (0.5, 1.0, 2.0, 4.0)}
    return SoftMethod(answer, tried, held=field_bytes, texel_floats=0, by_rays=True)


METHODS = {f"field_{count}": _by_fields(count) for count in (1, 4, 16)}

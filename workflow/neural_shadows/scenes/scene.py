"""Scenes: objects, lights, ground plane and tracer."""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from neural_shadows.scenes.lights import axis_vector
from neural_shadows.scenes.tracing import Tracer
from neural_shadows.settings.records import LightSettings

if TYPE_CHECKING:
    from neural_shadows.meshes.prepared_mesh import PreparedMesh


@dataclass(frozen=True, eq=False)
class Scene:
    """Objects and lights in one space, with their tracer.

    The space is normalised space of a single object, or metres.
    """

    objects: tuple["PreparedMesh", ...]
    lights: tuple[LightSettings, ...]  # domain of light directions; empty in metres
    up: np.ndarray  # (3,) float64, unit vector
    ground: float | None  # height of the ground plane along `up`; None without one
    tracer: Tracer

    @cached_property
    def joined(self) -> "PreparedMesh":
        """All objects as one mesh, faces in the tracer's order."""
        from neural_shadows.meshes.prepared_mesh import joined_meshes

        return joined_meshes(self.objects)

    @cached_property
    def owner(self) -> np.ndarray:
        """Object index of each face of the joined mesh, (F,) int64."""
        counts = [len(mesh.faces) for mesh in self.objects]
        return np.repeat(np.arange(len(counts)), counts)

    @cached_property
    def size(self) -> float:
        """Longest side of the bounding box of all objects."""
        return float(np.ptp(self.joined.vertices, axis=0).max())

    @cached_property
    def ball(self) -> tuple[np.ndarray, float]:
        """Middle (3,) float64 of the bounding box, and radius of the sphere about it."""
        vertices = self.joined.vertices.astype(np.float64)
        middle = (vertices.min(0) + vertices.max(0)) / 2
        return middle, float(np.linalg.norm(vertices - middle, axis=1).max())

    @cached_property
    def cumulative_area(self) -> np.ndarray:
        """Cumulative sum of doubled face areas, (F,) float64."""
        (mesh,) = self.objects
        a, b, c = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
        return np.cumsum(np.linalg.norm(np.cross(b - a, c - a), axis=1), dtype=np.float64)


def make_scene(
    *objects: "PreparedMesh", up: np.ndarray, ground: bool, light: LightSettings | None
) -> Scene:
    """Make a scene of objects, optionally with a ground plane.

    Args:
        up: (3,) unit vector.
        ground: adds a ground plane at the height of the objects' lowest vertex.
        light: domain of light directions, see `draw_light`; None for lights at positions.
    """
    from neural_shadows.meshes.prepared_mesh import joined_meshes

    up = np.asarray(up, np.float64)
    joined = joined_meshes(objects)
    height = float((joined.vertices @ up.astype(np.float32)).min()) if ground else None
    lights = () if light is None else (light,)
    return Scene(objects, lights, up, height, Tracer(joined.vertices, joined.faces))


def open_scene(mesh_ply: Path, *, up: str, ground: bool, light: LightSettings) -> Scene:
    """Read a prepared mesh and build its acceleration structure.

    Args:
        up: "x", "y" or "z".
        ground, light: see `make_scene`.

    Raises:
        InputError: the file cannot be read as a prepared mesh.
    """
    # Importing trimesh takes 0.4 s, needless in jobs that only read references.
    from neural_shadows.meshes.prepared_mesh import read_prepared

    mesh = read_prepared(mesh_ply)
    return make_scene(mesh, up=axis_vector(up), ground=ground, light=light)

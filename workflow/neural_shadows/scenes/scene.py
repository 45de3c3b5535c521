"""What is lit and seen, as one value."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from neural_shadows.scenes.lights import axis_vector
from neural_shadows.scenes.tracing import Tracer
from neural_shadows.settings.records import LightSettings

if TYPE_CHECKING:
    from neural_shadows.meshes.prepared_mesh import PreparedMesh


@dataclass(frozen=True, eq=False)
class Scene:
    """Objects and lights in one space, and the tracer over all objects.

    The space is the normalised one of a single object, or metres.
    """

    objects: tuple["PreparedMesh", ...]
    lights: tuple[Mapping[str, Any], ...]  # the domain of the light's direction; none in metres
    up: np.ndarray  # (3,) float64, unit vector
    ground: float | None  # height of the ground plane along `up`; None for a scene without one
    tracer: Tracer

    @cached_property
    def joined(self) -> "PreparedMesh":
        """All objects as one mesh, whose faces are in the tracer's order."""
        from neural_shadows.meshes.prepared_mesh import joined_meshes

        return joined_meshes(self.objects)

    @cached_property
    def owner(self) -> np.ndarray:
        """Which object each face of the joined mesh is of: (F,) int64."""
        counts = [len(mesh.faces) for mesh in self.objects]
        return np.repeat(np.arange(len(counts)), counts)

    @cached_property
    def size(self) -> float:
        """The longest side of the box round all objects."""
        return float(np.ptp(self.joined.vertices, axis=0).max())

    @cached_property
    def cumulative_area(self) -> np.ndarray:
        """Running sum of twice the areas of the faces: (F,) float64."""
        (mesh,) = self.objects
        a, b, c = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
        return np.cumsum(np.linalg.norm(np.cross(b - a, c - a), axis=1), dtype=np.float64)


def make_scene(
    *objects: "PreparedMesh", up: np.ndarray, ground: bool, light: LightSettings | None
) -> Scene:
    """A scene of objects as they lie, under which a ground plane may lie.

    Args:
        up: (3,) unit vector.
        ground: whether there is a ground plane, at the height of the objects' lowest vertex.
        light: the domain of the light's direction, see `draw_light`; None where lights have places.
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
        InputError: the file cannot be read as a prepared mesh, or the axis is unknown.
    """
    # trimesh takes 0.4 s to import, which jobs that read a scene's references need not wait for.
    from neural_shadows.meshes.prepared_mesh import read_prepared

    mesh = read_prepared(mesh_ply)
    return make_scene(mesh, up=axis_vector(up, "up"), ground=ground, light=light)

"""What is lit and seen, as one value."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from neural_shadows.scenes.lights import axis_vector
from neural_shadows.scenes.tracing import Tracer

if TYPE_CHECKING:
    from neural_shadows.meshes.prepared_mesh import PreparedMesh


@dataclass(frozen=True, eq=False)
class Scene:
    """Objects and lights in normalised space, and the tracer over all objects."""

    objects: tuple["PreparedMesh", ...]  # so far one
    lights: tuple[Mapping[str, Any], ...]  # so far one: the domain that a frame's light is from
    up: np.ndarray  # (3,) float64, unit vector
    ground: float | None  # height of the ground plane along `up`; None for a scene without one
    tracer: Tracer

    @cached_property
    def joined(self) -> "PreparedMesh":
        """All objects as one mesh, whose faces are in the tracer's order."""
        from neural_shadows.meshes.prepared_mesh import joined_meshes

        return joined_meshes(self.objects)

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
    mesh: "PreparedMesh", *, up: np.ndarray, ground: bool, light: Mapping[str, Any]
) -> Scene:
    """A scene of one object, under which a ground plane may lie.

    Args:
        up: (3,) unit vector.
        ground: whether there is a ground plane, at the height of the object's lowest vertex.
        light: the domain of the light's direction, see `draw_light`.
    """
    up = np.asarray(up, np.float64)
    height = float((mesh.vertices @ up.astype(np.float32)).min()) if ground else None
    return Scene((mesh,), (light,), up, height, Tracer(mesh.vertices, mesh.faces))


def open_scene(mesh_ply: Path, *, up: str, ground: bool, light: Mapping[str, Any]) -> Scene:
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

"""A scene as its cameras see it, opened once for all that is measured on its frames."""

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from neural_shadows.meshes.prepared_mesh import PreparedMesh, read_prepared
from neural_shadows.rendering.gbuffer import ShadingPoints, ground_height, primary_hits
from neural_shadows.rendering.viewpoints import draw_viewpoints
from neural_shadows.scenes.cameras import Viewpoint
from neural_shadows.scenes.lights import axis_vector
from neural_shadows.scenes.tracing import Tracer


@dataclass(frozen=True, eq=False)
class SceneFrames:
    """A prepared mesh with its tracer, and how its frames are drawn and rendered."""

    mesh: PreparedMesh
    tracer: Tracer
    up: np.ndarray  # (3,) unit vector
    ground: float | None  # height of the ground plane along `up`
    light: dict[str, Any]  # light domain, see `draw_light`
    width: int  # pixels
    height: int
    seed: int

    def viewpoints(self, view_sets: Iterable[str], indices: Iterable[int]) -> list[Viewpoint]:
        """See `draw_viewpoints`."""
        return draw_viewpoints(
            self.mesh,
            self.tracer,
            up=self.up,
            ground=self.ground is not None,
            light_domain=self.light,
            view_sets=view_sets,
            indices=indices,
            width=self.width,
            height=self.height,
            seed=self.seed,
        )

    def points(self, view: Viewpoint) -> ShadingPoints:
        """See `primary_hits`."""
        return primary_hits(self.mesh, self.tracer, view, self.width, self.height, self.ground)


def open_scene(
    mesh_ply: Path,
    *,
    up: str,
    ground: bool,
    light: dict[str, Any],
    width: int,
    height: int,
    seed: int,
) -> SceneFrames:
    """Read a prepared mesh and build its acceleration structure.

    Args:
        up: axis by name, such as `+y`.
        ground: whether a ground plane lies under the object.

    Raises:
        InputError: the file is not whole, or the axis is unknown.
    """
    mesh = read_prepared(mesh_ply)
    up_vector = axis_vector(up, "up")
    ground_at = ground_height(mesh, up_vector) if ground else None
    tracer = Tracer(mesh.vertices, mesh.faces)
    return SceneFrames(mesh, tracer, up_vector, ground_at, light, width, height, seed)

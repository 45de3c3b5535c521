"""A slice of an object, with a light's rays."""

from dataclasses import dataclass

import numpy as np
import trimesh

from neural_shadows.rays.labels import dual_bounds
from neural_shadows.scenes.scene import Scene
from neural_shadows.scenes.tracing import Tracer

LIGHT_ELEVATION = 50.0  # degrees in the plane: shadows as long as the object is high


@dataclass(frozen=True, eq=False)
class MeshSlice:
    """An object's section along its greatest horizontal extent."""

    across: np.ndarray  # (3,) unit vector, drawn to the right
    up: np.ndarray  # (3,) unit vector, drawn upwards
    # (k, 2, 2) float64, segments (x, y) in the upright plane through the origin
    outline: np.ndarray
    direction: np.ndarray  # (3,) d = −l, down to the right
    tracer: Tracer

    def to_space(self, points: np.ndarray) -> np.ndarray:
        """Convert plane points (n, 2) to normalised space (n, 3)."""
        return points @ np.stack([self.across, self.up])


@dataclass(frozen=True, eq=False)
class SliceRays:
    """A slice's parallel rays from the unit circle, with bounds."""

    offset: np.ndarray  # (n,) across the rays
    origins: np.ndarray  # (n, 2) entry points o in the plane
    direction: np.ndarray  # (2,) d in the plane
    chord: np.ndarray  # (n,) ℓ
    t_lb: np.ndarray  # (n,)
    t_ub: np.ndarray  # (n,), ∞ without a second hit

    @property
    def hit(self) -> np.ndarray:
        """The mask of rays with a hit, (n,) bool."""
        return self.t_lb < self.chord - 1e-6

    @property
    def end(self) -> np.ndarray:
        """The upper bound, or the end of the chord: (n,)."""
        return np.minimum(self.t_ub, self.chord)

    def at(self, t: np.ndarray) -> np.ndarray:
        """Points o + t d of the plane, (n, 2)."""
        return self.origins + t[:, None] * self.direction


def slice_mesh(scene: Scene) -> MeshSlice:
    """Cut a scene's object by the plane of a `MeshSlice`."""
    (mesh,), up = scene.objects, scene.up
    horizontal = [axis for axis in np.eye(3) if axis @ up == 0]
    across = max(horizontal, key=lambda axis: np.ptp(mesh.vertices @ axis))
    shape = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)
    segments = trimesh.intersections.mesh_plane(shape, np.cross(across, up), np.zeros(3))
    elevation = np.radians(LIGHT_ELEVATION)
    direction = np.cos(elevation) * across - np.sin(elevation) * up
    basis = np.stack([across, up], axis=1)
    outline = np.asarray(segments).reshape(-1, 2, 3) @ basis
    return MeshSlice(across, up, outline, direction, scene.tracer)


def slice_rays(cut: MeshSlice, count: int) -> SliceRays:
    """Labelled parallel rays of the slice's light, evenly spaced."""
    offset = (2 * np.arange(count) + 1) / count - 1
    # A little inside the circle, as training rays are: no tangents.
    offset *= 0.995
    d = np.stack([cut.across, cut.up]) @ cut.direction
    origins = offset[:, None] * np.array([-d[1], d[0]]) - np.sqrt(1 - offset**2)[:, None] * d
    o, along = cut.to_space(origins).astype(np.float32), cut.direction.astype(np.float32)
    t_lb, t_ub = dual_bounds(cut.tracer, o, along)
    return SliceRays(offset, origins, d, 2 * np.sqrt(1 - offset**2), t_lb, t_ub)

"""Several objects in metres, and where light, camera and further objects may be among them.

y is up and the floor at y = 0.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from trimesh.transformations import rotation_matrix

from neural_shadows.errors import InputError
from neural_shadows.meshes.prepared_mesh import PreparedMesh, all_with_normals
from neural_shadows.scenes.scene import Scene, make_scene

UP = np.array([0.0, 1.0, 0.0])


@dataclass(frozen=True, eq=False)
class Placed:
    """One object where it stands."""

    name: str
    vertices: np.ndarray  # (V, 3) float32, metres
    faces: np.ndarray  # (F, 3) int32, none without area


@dataclass(frozen=True, eq=False)
class Region:
    """A box with sides along the axes that positions are drawn from."""

    low: np.ndarray  # (3,) float64, metres
    high: np.ndarray  # (3,) float64, metres

    def draw(self, rng: np.random.Generator) -> np.ndarray:
        """A position, (3,) float64, uniform in the box."""
        return rng.uniform(self.low, self.high)


@dataclass(frozen=True, eq=False)
class Spot:
    """Where an inserted object may stand."""

    place: np.ndarray  # (3,) float64, metres, under its middle
    height: float  # metres: it is nowhere higher or wider
    turn: float  # radians, about y


@dataclass(frozen=True, eq=False)
class Arrangement:
    """Objects and the places among them."""

    name: str
    objects: tuple[Placed, ...]
    spots: tuple[Spot, ...]
    lights: Region  # centres of the light, 0.3 m or more from all objects
    cameras: Region  # eyes; here and there one is near an object
    targets: Region  # what cameras look at
    mover: str  # name of the object that sequences move
    lit: tuple[float, float] = (0.05, 0.95)  # the share of a frame that the light's centre reaches


def scene_of(
    arrangement: Arrangement,
    inserted: Mapping[str, PreparedMesh] | None = None,
    moved: np.ndarray | None = None,
) -> Scene:
    """The scene of an arrangement: its objects in order, then the inserted ones.

    Args:
        inserted: meshes in normalised space by name; the first stands on the first spot.
        moved: (4, 4) rigid motion in metres of the `mover`.

    Raises:
        InputError: more objects are inserted than there are spots.
    """
    inserted = inserted or {}
    if len(inserted) > len(arrangement.spots):
        raise InputError(
            f"{arrangement.name}: {len(inserted)} objects to insert ({', '.join(inserted)}), "
            f"but {len(arrangement.spots)} spots"
        )
    motions = {} if moved is None else {arrangement.mover: moved}
    meshes = []
    for part in arrangement.objects:
        motion = motions.get(part.name)
        vertices = part.vertices if motion is None else _carried(part.vertices, motion)
        meshes.append((vertices, part.faces))
    for mesh, spot in zip(inserted.values(), arrangement.spots):
        meshes.append((_stood(mesh, spot), mesh.faces))
    return make_scene(*all_with_normals(meshes), up=UP, ground=False, light=None)


def _carried(vertices: np.ndarray, motion: np.ndarray) -> np.ndarray:
    """Vertices after a (4, 4) motion: (V, 3) float32."""
    return (vertices @ motion[:3, :3].T + motion[:3, 3]).astype(np.float32)


def _stood(mesh: PreparedMesh, spot: Spot) -> np.ndarray:
    """Vertices of a mesh from its unit sphere on a spot, (V, 3) float32: the sphere becomes as high as
    the spot allows.
    """
    turned = _carried(mesh.vertices, rotation_matrix(spot.turn, UP)) * (spot.height / 2)
    turned[:, 1] -= turned[:, 1].min()
    return (turned + spot.place).astype(np.float32)

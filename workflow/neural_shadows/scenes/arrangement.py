"""Objects in metres, with regions for lights, cameras and insertions.

y is up and the floor at y = 0.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from neural_shadows.errors import InputError
from neural_shadows.meshes.prepared_mesh import PreparedMesh, all_with_normals
from neural_shadows.scenes.scene import Scene, make_scene

UP = np.array([0.0, 1.0, 0.0])
INSERTED = "inserted"  # the first inserted object


@dataclass(frozen=True, eq=False)
class Placed:
    """One object in scene coordinates."""

    name: str
    vertices: np.ndarray  # (V, 3) float32, metres
    faces: np.ndarray  # (F, 3) int32, all with an area


@dataclass(frozen=True, eq=False)
class Region:
    """Axis-aligned box of random positions."""

    low: np.ndarray  # (3,) float64, metres
    high: np.ndarray  # (3,) float64, metres

    def draw(self, rng: np.random.Generator) -> np.ndarray:
        """A position, (3,) float64, uniform in the box."""
        return rng.uniform(self.low, self.high)


@dataclass(frozen=True, eq=False)
class Spot:
    """Position of an inserted object."""

    position: np.ndarray  # (3,) float64, metres, below its centre
    height: float  # metres, the largest height and width of the object
    turn: float  # radians, about y


@dataclass(frozen=True, eq=False)
class Arrangement:
    """Objects, with regions for lights and cameras."""

    name: str
    objects: tuple[Placed, ...]
    spots: tuple[Spot, ...]
    lights: Region  # centres of the light, 0.3 m or more from all objects
    cameras: Region  # eyes; some are near an object
    targets: Region  # of cameras
    mover: str  # name of the object moved in sequences, or `INSERTED`
    lit: tuple[float, float] = (0.05, 0.95)  # range of a frame's lit share, for the light's centre

    @property
    def mover_index(self) -> int:
        """Index of the mover among all objects, inserted ones last."""
        names = [*(part.name for part in self.objects), INSERTED]
        return names.index(self.mover)


def scene_of(
    arrangement: Arrangement,
    inserted: Mapping[str, PreparedMesh] | None = None,
    moved: np.ndarray | None = None,
) -> Scene:
    """Scene of an arrangement's objects, followed by inserted ones.

    Args:
        inserted: meshes in normalised space by name, in the order of spots.
        moved: (4, 4) rigid motion in metres of the `mover`.

    Raises:
        InputError: more objects than spots.
    """
    inserted = inserted or {}
    if len(inserted) > len(arrangement.spots):
        raise InputError(
            f"{arrangement.name}: {len(inserted)} inserted objects ({', '.join(inserted)}), "
            f"but {len(arrangement.spots)} spots. Insert fewer"
        )
    meshes = [(part.vertices, part.faces) for part in arrangement.objects]
    for mesh, spot in zip(inserted.values(), arrangement.spots):
        meshes.append((_on_spot(mesh, spot), mesh.faces))
    if moved is not None:
        vertices, faces = meshes[arrangement.mover_index]
        meshes[arrangement.mover_index] = _moved(vertices, moved), faces
    return make_scene(*all_with_normals(meshes), up=UP, ground=False, light=None)


def _moved(vertices: np.ndarray, motion: np.ndarray) -> np.ndarray:
    """Vertices (V, 3) float32 after a (4, 4) motion."""
    return (vertices @ motion[:3, :3].T + motion[:3, 3]).astype(np.float32)


def _on_spot(mesh: PreparedMesh, spot: Spot) -> np.ndarray:
    """Vertices (V, 3) float32 of a normalised mesh on a spot.

    The unit sphere is scaled to the height of the spot.
    """
    from trimesh.transformations import rotation_matrix  # up to 0.8 s, needless with arrays alone

    turned = _moved(mesh.vertices, rotation_matrix(spot.turn, UP)) * (spot.height / 2)
    turned[:, 1] -= turned[:, 1].min()
    return (turned + spot.position).astype(np.float32)

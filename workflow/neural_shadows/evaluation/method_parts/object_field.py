"""The distance field of one object: fitted, marched, stored."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, fields
from functools import cached_property
from hashlib import sha256
from pathlib import Path

import numpy as np
import trimesh

from neural_shadows.errors import InputError
from neural_shadows.files.whole_files import whole_file
from neural_shadows.meshes.prepared_mesh import PreparedMesh, with_normals
from neural_shadows.representations.distance_bricks.brick_distances import REACH, signed_distances
from neural_shadows.representations.distance_bricks.brick_layout import lay_out
from neural_shadows.representations.distance_bricks.distances_around import distances_around
from neural_shadows.representations.distance_bricks.field_cones import ConeField
from neural_shadows.representations.distance_bricks.field_marching import (
    BRICK,
    SAMPLES_PER_CELL,
    mark_blocked,
)
from neural_shadows.representations.distance_bricks.surface_fit import fitted_distances
from neural_shadows.representations.voxels.occupancy import surface_cells

MOST = 256  # cells along an axis
_MARGIN = 1.02  # of an object's sphere, so that its surface is inside the grid


@dataclass(frozen=True, eq=False)
class ObjectField:
    """The field of a closed object, int8 values in bricks. Lengths are in the scene's unit."""

    centre: np.ndarray  # (3,) float32
    radius: np.float32  # of the sphere that the grid's cube is around
    grid: np.ndarray  # (n, n, n) int32, see `lay_out`
    bricks: np.ndarray  # (count, 125) int8

    @property
    def resolution(self) -> int:
        """Cells along an axis."""
        return len(self.grid) * BRICK

    def block(self, points: np.ndarray, to_light: np.ndarray, blocked: np.ndarray) -> None:
        """Mark blocked vectors (n, 3) from their points, see `mark_blocked`."""
        steps = SAMPLES_PER_CELL * self.resolution
        field = self.grid, self.bricks, steps, np.float32(0)
        mark_blocked(points, to_light, self.centre, self.radius, *field, blocked)

    @cached_property
    def cone_field(self) -> ConeField:
        """Values, and distances beyond them, for cones."""
        unit = np.float32(REACH / 127 * 2 / self.resolution)
        around = distances_around(self.grid, self.bricks).ravel()
        return ConeField(self.grid, self.bricks, unit, around)

    @property
    def bytes(self) -> int:
        """In memory while rays are marched."""
        return self.grid.nbytes + self.bricks.nbytes


def fitted_field(mesh: PreparedMesh, cell: float) -> ObjectField | None:
    """The field of an object in place; None of an open one.

    Its cells are this wide if `MOST` allows. An open mesh has no inside.
    """
    merged = _merged(mesh)
    # 4 faces an edge where two parts of an object touch.
    if np.any(np.bincount(merged.edges_unique_inverse) % 2):
        return None
    centre = (mesh.vertices.min(0) + mesh.vertices.max(0)).astype(np.float32) / 2
    reach = np.linalg.norm(mesh.vertices - centre, axis=1).max()
    radius = np.float32(_MARGIN * reach)
    wanted = int(np.ceil(2 * radius / cell / BRICK)) * BRICK
    resolution = int(np.clip(wanted, 8 * BRICK, MOST))
    unit = with_normals((merged.vertices - centre) / radius, merged.faces)
    surface = surface_cells(unit.vertices, unit.faces, resolution // BRICK)
    layout = lay_out(surface, solid=True)
    distances = signed_distances(unit, layout, REACH)  # in cells, positive inside
    # Unfitted ones cut off convex edges. Eight cones of a sun of 1° past the Stanford dragon
    # then had 2.3 times the squared error, that of 5.3 rays instead of 9.2.
    distances = fitted_distances(unit, layout, distances).clip(-REACH, REACH)
    values = np.round(127 / REACH * distances).astype(np.int8)
    return ObjectField(centre, radius, layout.grid, values[layout.table])


def _merged(mesh: PreparedMesh) -> trimesh.Trimesh:
    """The mesh with merged vertices: generated objects have one a face."""
    return trimesh.Trimesh(mesh.vertices, mesh.faces, process=True)


def field_key(mesh: PreparedMesh, cell: float) -> str:
    """A digest of a field's mesh, position and cell size."""
    content = mesh.vertices.tobytes() + mesh.faces.tobytes() + np.float64(cell).tobytes()
    return sha256(content).hexdigest()


def write_fields(path: Path, fields_by_key: Mapping[str, ObjectField]) -> None:
    """Write fields by their keys, one compressed npz."""
    arrays = {
        f"{key}.{attribute.name}": getattr(field, attribute.name)
        for key, field in fields_by_key.items()
        for attribute in fields(ObjectField)
    }
    with whole_file(path) as part, part.open("wb") as file:
        np.savez_compressed(file, **arrays)


class StoredFields:
    """A file of `write_fields`, read field by field.

    Raises:
        InputError: the file is missing or damaged, here or when a field is read.
    """

    def __init__(self, path: Path):
        self._path = path
        with self._opened() as arrays:
            self._keys = {name.partition(".")[0] for name in arrays.files}

    def get(self, key: str) -> ObjectField | None:
        """The field of a key, or None."""
        if key not in self._keys:
            return None
        with self._opened() as arrays:
            stored = {each.name: arrays[f"{key}.{each.name}"] for each in fields(ObjectField)}
        return ObjectField(**stored | {"radius": np.float32(stored["radius"])})

    @contextmanager
    def _opened(self) -> Iterator[np.lib.npyio.NpzFile]:
        try:
            with self._path.open("rb") as file, np.load(file, allow_pickle=False) as arrays:
                yield arrays
        except Exception as error:  # zipfile and zlib raise many kinds
            raise InputError(
                f"{self._path}: damaged ({error}). Delete it and run again."
            ) from error
